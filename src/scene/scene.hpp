#pragma once

#include "analysis/reference.hpp"
#include "analysis/watched_motion.hpp"
#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "physics/mechanism_assembly.hpp"
#include "scene/preset.hpp"
#include "track/replay.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A moment of a motion: a share, 0 ≤ share < 1, of the way from a sample to the next.
struct Moment {
    long sample = 0;
    double share = 0;

    friend auto operator<=>(const Moment&, const Moment&) = default;  // NOLINT(modernize-use-nullptr): as in faults.hpp
};
/// So many samples from the start; at a sample where it is within 1e-6 of one.
Moment moment_at(double samples);

/// Which moments of the motion the frames of a film show: at one speed frame n is n · stride samples from the start, exactly.
/// The last frame shows the end of the motion, wherever the one before it is.
struct FrameTimes {
    Rational stride{1, 1};         // samples from frame to frame, at one speed
    std::vector<Moment> changing;  // where the speed changes: each frame's but the last
    Moment last;
    long count = 0;

    Moment at(long frame) const;
    /// The first frame at that moment or later; count where there is none.
    long first_from(const Moment& moment) const;
};

/// The frames of a motion of `samples`.
FrameTimes frame_times(const Preset& preset, const Rational& fps, long samples);

/// How long the film takes to show the motion up to `time`, s, where the speed changes: between the end of one speed
/// and the next the film's seconds a second of motion go over by 3u² − 2u³.
double film_time(const VideoSpec& video, double time);

/// The speed that holds, or to which or from which it is nearer, at `time`, s.
Rational speed_at(const VideoSpec& video, double time);

/// What an accuracy that was asked for came to. Errors are in rad, the largest of all angles; of what hangs in no
/// chain, those of places in units of its size.
struct MethodChoice {
    double accuracy;         // asked for
    double estimated_error;  // up to the horizon
    long horizon;            // the sample up to which the run is that accurate; the last where it is to the end
    std::shared_ptr<const ReferenceTrajectory> reference;  // by which this is known
    double work;                                           // to the end, method_choice.hpp
};

/// One thing to draw. A rod and a spring go from end to end; an anchor is at `from`; a straight slot goes from `from`
/// to `to`; a circular one has its centre at `from`.
struct MechanismLine {
    enum class Kind { rod, spring, anchor, slot_line, slot_circle };
    Kind kind;
    End<double> from, to;
    double radius = 0;  // m, of a circular slot
    float width = 1;    // of a rod, in those of a massless one
};

/// What a picture needs besides the particles: the constraints in their order, then the springs in theirs.
std::vector<MechanismLine> lines_of(const Assembly<double>& assembly);
/// Of a chain: rod below rod, from the pivot.
std::vector<MechanismLine> lines_of(const Pendulum<double>& chain);

/// One side with everything chosen.
struct Side {
    MotionSpec motion;
    std::optional<Replay> replay;        // of a side that shows a track: what is not simulated
    std::string why;                     // this model
    std::optional<MethodChoice> choice;  // where an accuracy was asked for
    MethodEntry method{};
    Rational step{0, 1};          // s; of methods with a fixed step
    std::vector<double> mass;     // kg, a bob each
    bool has_angles = true;       // a chain, whose bobs hang one below the other
    double gravity = 0;           // m/s²
    double energy_unit = 0;       // J, what an error of its energy is measured by in pictures (the potential range)
    double lowest_potential = 0;  // J, of a chain: hanging straight down, its pivot as low as it goes
    double reach = 0;  // m, from the pivot to the end of the outstretched chain; of a mechanism, its size_of()
    bool has_energy_error =
        true;                // all that changes the energy is known (Observation::work): simulated, no damped spring
    bool has_work = false;   // by friction or drive on a chain
    double pivot_reach = 0;  // m, how far the pivot moves from the origin
    std::vector<MechanismLine> lines;  // what is drawn besides the bobs
};

/// What of a track is shown. Throws Error (exit 2) where it has no sample at its start.
Replay replay_of(const TrackSpec& spec);
/// A whole number of samples, up to the last that it holds, s.
Rational longest_duration(const Replay& replay, const Rational& sample_hz);

/// The names of the models that a method steps.
std::vector<std::string_view> models_of(const MethodEntry& method);

/// The chain as written, in radians.
Pendulum<Quad> chain_of(const SideSpec& spec);
/// The same with what a real chain has besides.
PhysicalPendulum<Quad> physical_of(const SideSpec& spec);

/// The particles of a side (those of its chain, "bob1", "bob2" …, where it names none), its constraints and forces, and
/// gravity. Throws Error (exit 2) where a part names a particle that is not there.
Assembly<Quad> assembly_of(const SideSpec& spec);

/// A side with its model chosen, the smallest that serves, and everything in exact numbers. Throws Error (exit 2) where
/// the system is faulty.
Side make_side(const SideSpec& spec, const Rational& sample_hz);

/// `make()`, whose errors say whose they are: "NAME: side a: …".
template <class Make>
auto for_side(const Preset& preset, char name, const Make& make) {
    try {
        return make();
    } catch (const Error& fault) {
        if (fault.code() == ExitCode::interrupted) throw;
        throw Error(fault.code(), fmt::format("{}: side {}: {}", preset.name, name, fault.what()));
    }
}

class MethodChooser;

/// What a preset comes to: the models chosen, the clock in whole numbers.
struct Scene {
    Preset preset;
    Side a, b;
    long samples;                            // of the run: 0 … samples, both ends included
    std::vector<MotionSpec> members;         // of an ensemble: from a to b in equal steps of all numbers, both included
    Rational fps;                            // frames/s of the video
    FrameTimes frames;                       // which moments they show
    std::shared_ptr<MethodChooser> chooser;  // where a side requires an accuracy

    double time(const Moment& moment) const;  // s
    double time(long sample) const { return time(Moment{sample}); }
    /// Whether side b is none: nothing of it is simulated.
    bool is_single() const { return preset.video.layout == Arrangement::single; }
    /// The sides that it has.
    std::string_view letters() const { return is_single() ? "a" : "ab"; }
    const Side& side(char letter) const { return letter == 'a' ? a : b; }
    /// Where a side that was asked for an accuracy keeps it no longer, s; nothing where all do to the end.
    std::optional<double> horizon() const;
    /// By which pictures and manifest measure errors of the energy, J: the larger side's potential range.
    double energy_range() const { return std::max(a.energy_unit, b.energy_unit); }
};

/// Throws Error: exit 2 where a system is faulty, the two sides differ by less than their precision can tell, or an
/// accuracy is out of reach; exit 130 soon after `stop` is set (choosing by accuracy takes runs of its own).
Scene make_scene(const Preset& preset, const std::atomic<bool>& stop = false);

/// Throws Error (exit 2) where what sets the sides apart is lost in their precision: a number of any key that differs and
/// is the same to compute with; all of the system; or the pull of a droplet, beside gravity.
void check_difference(const Scene& scene);

/// Both sides and how they differ at a sample, or between two.
struct PairState {
    long sample = 0;   // the last one that is over
    double share = 0;  // of the way to the next one
    Observation a, b;
    std::optional<double> energy_error_a, energy_error_b;  // as SideRun::energy_error()
    std::optional<double> mean_energy_a, mean_energy_b;    // as SideRun::mean_energy()
    double distance = 0;                                   // state space, analysis/difference.hpp

    Moment moment() const { return {sample, share}; }
};

/// A side whose method failed (exit 3).
struct RunFailure : Error {
    RunFailure(const std::string& message, char side_name, long at_sample)
        : Error(ExitCode::method_failed, message), side(side_name), sample(at_sample) {}
    char side;    // 'a' or 'b'
    long sample;  // the first that is wrong
};

/// Of a side that is driven, s: the longest of its drives'.
std::optional<double> drive_period(const SideSpec& spec);

/// The mean of a quantity over the last period, from its values at samples, linear between them.
class PeriodMean {
public:
    /// s
    explicit PeriodMean(double period) : period_(period) {}
    void add(double time, double value);
    /// Up to a moment at or after the sample added last; nothing before a period is over.
    std::optional<double> at(double time, double value) const;

private:
    struct Point {
        double time, value, integral;  // s; the quantity; its integral from the first point on
    };
    static Point next(const Point& from, double time, double value) {
        return {time, value, from.integral + (time - from.time) * (from.value + value) / 2};
    }
    double period_;
    std::deque<Point> points_;
};

/// Steps one side from sample to sample, and watches it.
class SideRun {
public:
    /// `name` = 'a' or 'b', for errors.
    SideRun(const Scene& scene, const Side& side, char name);

    /// Sample 0, then 1, 2, … Throws RunFailure with time and quantity where a number is no longer finite, the energy is
    /// out of all proportion, a rod is off by its own length, or a step cannot be made; exit 130 soon after `stop` is
    /// set.
    Observation next(const std::atomic<bool>& stop);
    /// On to a moment before the next sample, or to that; Motion::advance_within() says what is at it with a fixed step.
    /// Throws as next().
    Observation advance_to(const Moment& moment, const std::atomic<bool>& stop);

    /// Relative (analysis/watched_motion.hpp); nothing where damping takes energy, so that no change of it is an error.
    std::optional<double> energy_error(const Observation& seen) const;
    /// J: of a driven side the mean over the drive's last period, once one is over.
    std::optional<double> mean_energy(const Observation& seen) const;
    Effort effort() const { return motion_->effort(); }

private:
    RunFailure broken(const std::string& what) const;
    void watch(const Observation& seen);

    const Scene& scene_;
    const Side& side_;
    char name_;
    std::unique_ptr<Motion> motion_;
    ErrorScale proportion_;
    std::optional<PeriodMean> energy_;  // of a driven side
    Moment now_{-1};
};

/// What of a side's masses is compared with the other's: all, or the last one where the sides differ in kind.
template <class Scalar>
Bobs<Scalar> compared_bobs(const Scene& scene, const Bobs<Scalar>& bobs) {
    return differ_in_kind(scene.preset.a, scene.preset.b) ? Bobs<Scalar>{bobs.back()} : bobs;
}

/// Throws Error where the sides are so far apart that their distance is out of the range of a double; it names the
/// number that makes it so. Exit 2 at the start, exit 3 later.
void check_distance(const Scene& scene, const PairState& state);

/// Steps the pair from sample to sample: large sides at the same time, on two threads.
class PairRun {
public:
    explicit PairRun(const Scene& scene)
        : scene_(scene),
          a_(scene, scene.a, 'a'),
          are_large_(std::min(scene.a.mass.size(), scene.b.mass.size()) >= large) {
        if (!scene.is_single()) b_.emplace(scene, scene.b, 'b');
    }

    /// Sample 0, then 1, 2, … Of a single pendulum side b is as side a. Throws as SideRun does.
    PairState next(const std::atomic<bool>& stop);
    PairState advance_to(const Moment& moment, const std::atomic<bool>& stop);

    Effort effort_a() const { return a_.effort(); }
    Effort effort_b() const { return b_ ? b_->effort() : Effort{}; }
    /// What other threads than the caller's have spent, s.
    double other_cpu_s() const { return other_cpu_s_; }

private:
    static constexpr std::size_t large = 256;  // masses; a sample takes longer than to start a thread

    void advance_sides(const std::atomic<bool>& stop, PairState& now);

    const Scene& scene_;
    SideRun a_;
    std::optional<SideRun> b_;
    bool are_large_;
    double other_cpu_s_ = 0;
    long sample_ = -1;
};

}  // namespace doppel

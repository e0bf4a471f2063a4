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
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A time: a fraction, 0 ≤ share < 1, of the interval from a sample to the next.
struct Moment {
    long sample = 0;
    double share = 0;

    friend auto operator<=>(const Moment&,
                            const Moment&) = default;  // NOLINT(modernize-use-nullptr): as in toml_reader.hpp
};
/// The moment so many samples after the start, rounded to a sample if it is within 1e-6 of one.
Moment moment_at(double samples);

/// The moments that the frames of a film show. At constant speed, frame n is exactly n · stride samples from the start.
/// The last frame always shows the end of the motion.
struct FrameTimes {
    Rational stride{1, 1};         // samples between frames, at constant speed
    std::vector<Moment> changing;  // if the speed changes: of each frame except the last
    Moment last;
    long count = 0;

    Moment at(long frame) const;
    /// The first frame at that moment or later; `count` if there is none.
    long first_from(const Moment& moment) const;
};

FrameTimes frame_times(const Preset& preset, const Rational& fps, long samples);

/// The film time at which the motion reaches `time`, s, if the speed changes. During a change, the slowness (film
/// seconds per second of motion) is interpolated by 3u² − 2u³.
double film_time(const VideoSpec& video, double time);

/// The speed at `time`, s; during a change, the nearer of the two.
Rational speed_at(const VideoSpec& video, double time);

/// The result of a required accuracy. Errors are the largest of all angles, rad; for mechanisms, of positions in units
/// of the system's size.
struct MethodChoice {
    double accuracy;         // required
    double estimated_error;  // up to the horizon
    long horizon;            // the sample up to which the run is that accurate; the last one if it always is
    std::shared_ptr<const ReferenceTrajectory> reference;  // from which this is known
    double work;                                           // for the whole run, method_choice.hpp
};

/// A line to draw. A rod or spring goes from end to end; an anchor is at `from`; a straight slot goes from `from` to
/// `to`; a circular one has its centre at `from`.
struct MechanismLine {
    enum class Kind { rod, spring, anchor, slot_line, slot_circle };
    Kind kind;
    End<double> from, to;
    double radius = 0;  // of a circular slot, m
    float width = 1;    // of a rod, relative to a massless one
};

/// Constraints in their order, then springs in theirs, as needed for drawing.
std::vector<MechanismLine> lines_of(const Assembly<double>& assembly);
/// For a chain: its rods, from the pivot on.
std::vector<MechanismLine> lines_of(const Pendulum<double>& chain);

/// One side with all choices made.
struct Side {
    MotionSpec motion;
    std::optional<Replay> replay;        // for a side that shows a measured track instead of a simulation
    std::string why;                     // reason for the model
    std::optional<MethodChoice> choice;  // if an accuracy was required
    MethodEntry method{};
    Rational step{0, 1};          // s; for methods with a fixed step
    std::vector<double> mass;     // kg, for each bob
    bool has_angles = true;       // a chain, in which each bob hangs from the previous one
    double gravity = 0;           // m/s²
    double energy_unit = 0;       // J, the potential range, by which errors of the energy are scaled in pictures
    double lowest_potential = 0;  // J, for a chain hanging straight down, with the pivot at its lowest position
    double reach = 0;  // m, from the pivot to the end of the outstretched chain; for a mechanism, its size_of()
    bool has_energy_error =
        true;  // all changes of energy are known (Observation::work): it is simulated and has no damped spring
    bool has_work = false;             // friction or drive of a chain
    double pivot_reach = 0;            // m, largest distance of the pivot from the origin
    std::vector<MechanismLine> lines;  // drawn in addition to the bobs
};

/// The shown part of a track. Throws Error (exit 2) if it has no sample at its start.
Replay replay_of(const TrackSpec& spec);
/// A whole number of samples, at most up to the last measured one, s.
Rational longest_duration(const Replay& replay, const Rational& sample_hz);

/// The names of the models that a method supports.
std::vector<std::string_view> models_of(const MethodEntry& method);

/// The chain of the preset, in radians.
Pendulum<Quad> chain_of(const SideSpec& spec);
/// The same with the properties of a rigid-body chain.
PhysicalPendulum<Quad> physical_of(const SideSpec& spec);

/// The names of a side's particles; of a chain, "bob1", "bob2" …
std::vector<std::string> particle_names(const SideSpec& spec);
/// The particles of a side or of its chain, its constraints, forces and gravity.
Assembly<Quad> assembly_of(const SideSpec& spec);

/// A side with the smallest suitable model, all numbers exact. Throws Error (exit 2) if the system is invalid.
Side make_side(const SideSpec& spec, const Rational& sample_hz);

/// Where the preset of a film has the key or entry; the preset's name if that is unknown, or for other errors.
std::string place_of(const Preset& preset, char side, const Error& error);

/// Calls make(); its errors get the prefix "PLACE: side a: ".
template <class Make>
auto for_side(const Preset& preset, char name, const Make& make) {
    try {
        return make();
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        throw Error(error.code(), fmt::format("{}: side {}: {}", place_of(preset, name, error), name, error.what()));
    }
}

class MethodChooser;
struct Certificate;
/// Samples done and to do; `arithmetic`, "quad". A proof begins again with more bits.
using ProofReport = std::function<void(long done, long total, const char* arithmetic)>;

/// A scene ready to run: the models are chosen, the clock is in whole numbers.
struct Scene {
    Preset preset;
    Side a, b;
    long samples;                            // of the run: 0 … samples, inclusive
    std::vector<MotionSpec> members = {};    // of an ensemble: from a to b in equal steps of all numbers, inclusive
    Rational fps = {};                       // frames/s of the video
    FrameTimes frames = {};                  // the moments they show
    std::shared_ptr<MethodChooser> chooser;  // if a side requires an accuracy
    std::shared_ptr<const Certificate> certificate{};  // if the preset requires it (scene/certificate.hpp)
    double made_wall_s = 0, made_cpu_s = 0;            // time to make it: choice of methods, certificate

    double time(const Moment& moment) const;  // s
    double time(long sample) const { return time(Moment{sample}); }
    /// Whether there is only side a; then side b is not simulated.
    bool is_single() const { return preset.video.layout == Arrangement::single; }
    std::string_view letters() const { return is_single() ? "a" : "ab"; }
    const Side& side(char letter) const { return letter == 'a' ? a : b; }
    /// The time at which a side first loses its required accuracy, s; nothing if all keep it to the end.
    std::optional<double> horizon() const;
    /// The scale of energy errors in pictures and manifests, J: the larger potential range of the sides.
    double energy_range() const { return std::max(a.energy_unit, b.energy_unit); }
};

/// Throws Error: exit 2 if a system is invalid, the sides differ by less than their precision can represent, or an
/// accuracy cannot be reached; exit 130 soon after `stop` is set (choosing by accuracy requires trial runs).
Scene make_scene(const Preset& preset, const std::atomic<bool>& stop = false, const ProofReport& report = {});

/// A side at a sample, or between two.
struct SideState : Observation {
    /// Relative (analysis/watched_motion.hpp); nothing if damping reduces the energy, so that its change is no error.
    std::optional<double> energy_error = {};
    /// J; for a driven side the mean over the last drive period, once one is over.
    std::optional<double> mean_energy = {};
};

/// Both sides and their difference.
struct PairState : Moment {
    SideState a = {}, b = {};
    double distance = 0;  // in state space, analysis/difference.hpp

    const Moment& moment() const { return *this; }
};

/// A side whose method failed (exit 3).
struct RunFailure : Error {
    RunFailure(const std::string& message, char side_name, long at_sample)
        : Error(ExitCode::method_failed, message), side(side_name), sample(at_sample) {}
    char side;    // 'a' or 'b'
    long sample;  // the first wrong one
};

/// The longest drive period of a side that is shorter than the motion, s; nothing without a drive.
std::optional<double> drive_period(const SideSpec& spec, const Rational& duration_s);

/// The mean of a quantity over the last period, from its values at samples, interpolated linearly.
class PeriodMean {
public:
    explicit PeriodMean(double period) : period_(period) {}
    void add(double time, double value);
    /// The mean up to a time at or after the last sample; nothing before one period is over.
    std::optional<double> at(double time, double value) const;

private:
    struct Point {
        double time, value, integral;  // s; the quantity; its integral since the first point
    };
    static Point next(const Point& from, double time, double value) {
        return {time, value, from.integral + (time - from.time) * (from.value + value) / 2};
    }
    double period_;
    std::deque<Point> points_;
};

/// Steps one side from sample to sample, and checks it.
class SideRun {
public:
    /// `name` = 'a' or 'b', for errors.
    SideRun(const Scene& scene, const Side& side, char name);

    /// Returns sample 0, then 1, 2, … Throws RunFailure with time and quantity if a number is not finite, errors of
    /// energy or rods are far too large, or a step fails; exit 130 soon after `stop` is set.
    SideState next(const std::atomic<bool>& stop) { return advance_to({now_.sample + 1}, stop); }
    /// Advances to a moment up to the next sample. With a fixed step, Motion::advance_within() says what that gives.
    /// Throws as next().
    SideState advance_to(const Moment& moment, const std::atomic<bool>& stop);
    Effort effort() const { return motion_->effort(); }

private:
    RunFailure broken(const std::string& what) const;
    void watch(const Observation& seen);

    const Scene& scene_;
    const Side& side_;
    char name_;
    std::unique_ptr<Motion> motion_;
    ErrorScale proportion_;
    std::optional<PeriodMean> energy_;  // for a driven side
    Moment now_{-1};
};

/// Throws Error if the distance of the sides exceeds the range of double: exit 2 at the start, exit 3 later.
void check_distance(const Scene& scene, const PairState& state);

/// Steps the pair from sample to sample; large sides in parallel on two threads.
class PairRun {
public:
    explicit PairRun(const Scene& scene)
        : scene_(scene),
          a_(scene, scene.a, 'a'),
          are_large_(std::min(scene.a.mass.size(), scene.b.mass.size()) >= large) {
        if (!scene.is_single()) b_.emplace(scene, scene.b, 'b');
    }

    /// Returns sample 0, then 1, 2, … For a single pendulum, side b is a copy of side a. Throws as SideRun does.
    PairState next(const std::atomic<bool>& stop) { return advance_to({sample_ + 1}, stop); }
    PairState advance_to(const Moment& moment, const std::atomic<bool>& stop);

    Effort effort_a() const { return a_.effort(); }
    Effort effort_b() const { return b_ ? b_->effort() : Effort{}; }
    double other_cpu_s() const { return other_cpu_s_; }

private:
    static constexpr std::size_t large = 256;  // masses, from which on a sample takes longer than starting a thread

    const Scene& scene_;
    SideRun a_;
    std::optional<SideRun> b_;
    bool are_large_;
    double other_cpu_s_ = 0;
    long sample_ = -1;
};

}  // namespace doppel

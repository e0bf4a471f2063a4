#pragma once

#include "analysis/difference.hpp"
#include "film/bounds.hpp"
#include "integrate/motion.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <exception>
#include <functional>
#include <vector>

namespace doppel {

/// The state at a sample, or between two where a frame is: the pair, and the bobs of an ensemble's members.
struct Snapshot {
    PairState pair;
    std::vector<Bobs<double>> members;
};

/// How far a pair came, from its samples in their order.
struct Outcome {
    double start_distance = 0, largest_distance = 0;  // state space
    Divergence parting{};

    void add(double time, const PairState& state) {
        if (state.sample == 0) start_distance = state.distance;
        largest_distance = std::max(largest_distance, state.distance);
        parting.add(time, state.distance);
    }
};

/// A side's largest errors, and its cost.
struct SideRecord {
    double energy_error = 0;   // relative to the energy at the start, however close to zero that is
    double energy_change = 0;  // J
    double length_error = 0;   // m
    Effort effort;
};

/// What came of the part of a motion that a run wants.
struct MotionRecord {
    SideRecord a, b;
    Outcome outcome;
};

/// How far a run is, as often as a frame or a sample is done.
struct Progress {
    long done, total;
};
using Report = std::function<void(const Progress&)>;

/// The motion of a scene up to a moment: its samples, and with pictures the frames between them and the members of an
/// ensemble (these also where the table has them). Where a picture depends on the whole motion (depends_on_motion()),
/// or is drawn after the others (the contact sheet), it is simulated at once and kept, some 0.7 kB a sample of a double
/// pendulum, 29 kB of 256 links; where that would take more than `most_bytes`, and for all other runs, it is simulated
/// as it is played.
class Recording {
public:
    static constexpr double usual_bytes = 256e6;

    /// The moments before `end`. `report` is told of all samples as they are simulated. `scene` and `stop` outlive the
    /// recording. Throws Error: exit 130 soon after `stop` is set, or of what comes after `end`; else play() throws.
    Recording(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop,
              Report report = {}, double most_bytes = usual_bytes);
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    using Visit = std::function<void(const Snapshot&)>;
    /// Calls visit(snapshot) in the order of time. Then throws what ended the simulation: Error, as SideRun::next() and
    /// check_distance() do.
    void play(const Visit& visit);

    /// Whether it is known that play() throws.
    bool fails() const { return fault_ != nullptr; }
    /// Of the whole motion, or up to where it fails: frames have the same pixels alone as in the film. Empty where no
    /// picture depends on it.
    const MotionBounds& bounds() const { return bounds_; }
    /// Complete after play().
    const MotionRecord& record() const { return record_; }
    /// Spent on simulating, s.
    double cpu_s() const { return cpu_s_; }

private:
    static constexpr long no_bounds = -1;
    double bytes() const;
    void simulate(long last, const Visit& visit);

    const Scene& scene_;
    const Moment end_;
    const bool with_pictures_;
    const std::atomic<bool>& stop_;
    const Report report_;
    std::deque<Snapshot> kept_;
    std::exception_ptr fault_;
    MotionBounds bounds_;
    MotionRecord record_;
    double cpu_s_ = 0;
    bool is_kept_ = false;
};

}  // namespace doppel

#pragma once

#include "analysis/difference.hpp"
#include "integrate/motion.hpp"
#include "output/blocks.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <vector>

namespace doppel {

/// The state at a sample, or at a frame between two: the pair, and the bobs of an ensemble's members.
struct Snapshot {
    PairState pair;
    std::vector<Bobs<double>> members;
};

/// With as many numbers as every snapshot of the scene has, all of them zero.
Snapshot blank_snapshot(const Scene& scene);

/// The range of numbers: of all of them, and of the positive ones on a logarithmic scale.
struct Spread {
    double low = 0, high = 0;
    double minimum = std::numeric_limits<double>::infinity(), maximum = 0;  // of the positive finite numbers
    double log_sum = 0;                                                     // of their natural logarithms
    long count = 0;

    void add(double value);
    double geometric_mean() const { return std::exp(log_sum / static_cast<double>(count)); }
};

/// The ranges of a whole motion, which a picture needs and no formula gives.
struct MotionBounds {
    static constexpr double far = std::numeric_limits<double>::infinity();
    double left = far, right = -far, bottom = far, top = -far;  // m, over all bobs of both sides and all samples
    double fastest = 0;                                         // rad/s, of the link shown in a phase panel
    std::array<Spread, strip_kinds> strips{};                   // for the strips of the film
    std::array<Spread, 64> distance{};                          // of the pair, in equal parts of the time

    /// Adds what lies within `radius` of a place, m.
    void add(double x, double y, double radius = 0);
    /// Adds the next sample.
    void add(const Scene& scene, const PairState& state, double start_distance);
};

/// A link passes the upright position.
struct Flip {
    double time_s;
    char side;
    std::size_t link;
};

/// Distances of a pair, and flips of chains of one to three links, updated sample by sample.
struct Outcome {
    double start_distance = 0, largest_distance = 0;  // in state space
    Divergence divergence{};
    std::vector<Flip> flips{};
    std::vector<double> turns{};  // of each link at the last sample, whole turns

    void add(const Scene& scene, const PairState& state);
};

/// Largest errors of a side, and its computing effort.
struct SideRecord {
    double energy_error = 0;   // relative to the initial energy, however close to zero that is
    double energy_change = 0;  // J
    double length_error = 0;   // m
    Effort effort;
};

/// The results of the part of a motion that a run requires.
struct MotionRecord {
    SideRecord a, b;
    Outcome outcome;
};

/// The progress of a run, reported after each frame or sample.
struct Progress {
    long done, total;
};
using Report = std::function<void(const Progress&)>;

/// Approximate memory of all snapshots of a scene before `end`, bytes.
double recorded_bytes(const Scene& scene, const Moment& end);

/// The motion of a scene up to a given time: its samples, and for pictures also the frames between them and the members
/// of an ensemble (which the table may require, too). The whole motion is simulated first and kept if a picture depends
/// on it (depends_on_motion()) or is drawn after the others (the contact sheet). This takes some 0.7 kB per sample for
/// a double pendulum, 29 kB for 256 links. If it would exceed `max_bytes`, and for all other runs, the motion is
/// simulated while it is played.
class Recording {
public:
    static constexpr double usual_bytes = 256e6;

    /// Records the snapshots before `end`. `scene` and `stop` must outlive the recording. The snapshots in a `file`
    /// replace the simulation. Throws Error: exit 130 soon after `stop` is set, and errors that occur after `end`;
    /// play() throws the others: also exit 2 if the file belongs to another motion or version, exit 4 if it cannot be
    /// read or is damaged.
    Recording(const Scene& scene, const Moment& end, bool with_pictures, const std::atomic<bool>& stop,
              std::filesystem::path file = {}, double max_bytes = usual_bytes);
    Recording(const Recording&) = delete;
    Recording& operator=(const Recording&) = delete;

    using Visit = std::function<void(const Snapshot&)>;
    /// Calls visit(snapshot) in order of time. Then throws the error that ended the simulation, if any.
    void play(const Visit& visit);

    /// Whether it is already known that play() will throw.
    bool fails() const { return error_ != nullptr; }
    /// Of the whole motion, or up to its failure; empty if no picture depends on them.
    const MotionBounds& bounds() const { return bounds_; }
    /// Complete after play().
    const MotionRecord& record() const { return record_; }
    double cpu_s() const { return cpu_s_; }

private:
    void simulate(bool is_bounded, const Visit& visit);

    const Scene& scene_;
    const Moment end_;
    const bool with_pictures_;
    const std::atomic<bool>& stop_;
    const std::filesystem::path file_;
    std::deque<Snapshot> kept_;
    std::exception_ptr error_;
    MotionBounds bounds_;
    MotionRecord record_;
    double cpu_s_ = 0;
    bool is_kept_ = false;
};

inline constexpr BlockKind recording_file{R"({"file":"doppel recording")", "is no recording of Doppel",
                                          "is damaged or incomplete; make it again with simulate --recording"};
/// The header of a recording's file, of which each block contains the numbers of a snapshot.
std::string recording_header(const Scene& scene);
/// Adds the next snapshot to such a file; the effort of both sides is that up to it.
void add_snapshot(BlockFile& recording, Snapshot snapshot, Effort a, Effort b);

}  // namespace doppel

#pragma once

#include "numeric/rational.hpp"

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

namespace doppel {

struct EnclosedSystem;

/// Proved bounds of a number, inclusive.
struct Interval {
    double low = 0, high = 0;
};

/// The precisions of enclosures, in bits: double, quad, and more.
inline constexpr std::array certified_bits{53, 113, 256};

struct CertifiedPairSpec {
    Rational interval{1, 120};     // between samples, s
    long samples = 0;              // 0 … samples
    std::optional<int> bits = {};  // only with these
    int jobs = 1;
    std::function<void(long done, long total)> report = {};  // of samples
};

/// Enclosures of the true motion of one or two sides at samples 0, 1 … as far as all are proved, and what follows for
/// their runs.
struct Certificate {
    struct Row {
        std::vector<std::array<Interval, 4>> sides{};  // θ1, θ2 (rad), ω1, ω2 (rad/s)
        double radius = 0;                             // the largest of all angles, rad
        Interval distance{};                           // of two sides, analysis/difference.hpp
    };
    /// For the run of a side, by its method: the time until which each angle is proved to be within the radius of the
    /// true one, at every sample; and the first at which one is proved to be farther from it, s.
    struct OfRun {
        std::optional<double> until_s{}, beyond_s{};
    };

    int bits = 0;
    std::vector<Row> rows{};
    double run_radius = 0;  // rad
    std::vector<OfRun> runs{};
    std::optional<Interval> diverged_s{};  // bounds of the true time of divergence (analysis/difference.hpp), s

    bool has_distance() const { return rows.front().sides.size() == 2; }
    /// The last sample that is proved.
    long last() const { return static_cast<long>(rows.size()) - 1; }
    /// The time until which the runs of all sides are, s.
    double run_until_s() const;
};

/// With the fewest bits for which all angles (rad) and rates (rad/s) are known to 1e-6 and the distance to 1 %,
/// otherwise with the most; without runs. Throws Error (exit 130) soon after `stop` is set.
Certificate certified_pair(const std::vector<EnclosedSystem>& sides, const CertifiedPairSpec& spec,
                           const std::atomic<bool>& stop);

}  // namespace doppel

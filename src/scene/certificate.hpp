#pragma once

#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// By which a run has left the true motion, rad.
inline constexpr double usual_run_radius = 0.5;

/// Proved bounds of a number, inclusive.
struct Interval {
    double low = 0, high = 0;
};

/// Enclosures of the true motion at samples 0, 1 … as far as all sides are proved, and what follows for their runs.
struct Certificate {
    struct Row {
        // of each side θ1, θ2 (rad), ω1, ω2 (rad/s); last, of two sides, their distance (analysis/difference.hpp)
        std::vector<Interval> bounds{};
        double radius = 0;  // the largest of all angles, rad
    };
    /// For the run of a side, by its method: the time until which each angle is proved to be within the radius of the
    /// true one, at every sample; and the first at which one is proved to be farther from it, s.
    struct OfRun {
        std::optional<double> until_s{}, beyond_s{};
    };

    std::size_t precision = 0;  // 0 for double, 1 for quad, 2 for 256 bits
    std::vector<Row> rows{};
    double run_radius = 0;  // rad
    std::vector<OfRun> runs{};
    std::optional<Interval> diverged_s{};  // bounds of the true time of divergence (analysis/difference.hpp), s

    /// The last sample that is proved.
    long last() const { return static_cast<long>(rows.size()) - 1; }
    /// The time until which the runs of all sides are, s.
    double run_until_s() const;
};

/// Throws Error (exit 2) unless the sides are two ideal links, with or without droplets.
void check_provable(const Scene& scene);

/// What is proved about a scene, with the fewest bits for which all angles (rad) and rates (rad/s) are known to 1e-6
/// and the distance to 1 %, otherwise with the most. Throws Error: as check_provable(); exit 130 soon after `stop` is set.
Certificate certificate_of(const Scene& scene, double radius, int jobs, const std::atomic<bool>& stop,
                           const ProofReport& report = {});

/// The radii of side a at all samples with a precision as Certificate::precision, rad; NaN where nothing is proved.
std::vector<double> certified_radii(const Scene& scene, std::size_t precision, const std::atomic<bool>& stop);

/// The results in sentences.
std::vector<std::string> certificate_words(const Scene& scene, const Certificate& proved);

Json certificate_json(const Scene& scene, const Certificate& proved);

}  // namespace doppel

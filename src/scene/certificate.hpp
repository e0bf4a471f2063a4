#pragma once

#include "analysis/certified_pair.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// What is proved about a scene.
struct Certificate {
    /// For the run of a side, by its method: the time until which each angle is proved to be within the radius of the
    /// true one, at every sample; and the first at which one is proved to be farther from it, s.
    struct OfRun {
        std::optional<double> until_s{}, beyond_s{};
    };

    CertifiedPair pair;
    double radius;                         // rad
    std::vector<OfRun> runs{};             // of each side
    std::optional<Interval> diverged_s{};  // bounds of the true time of divergence (analysis/difference.hpp), s

    /// The last sample that is proved.
    long last() const { return static_cast<long>(pair.rows.size()) - 1; }
    /// The time until which the runs of all sides are, s.
    double run_until_s() const;
};

/// By which a run has left the true motion, rad.
inline constexpr double usual_run_radius = 0.5;

/// Throws Error (exit 2) unless the sides are two ideal links, with or without droplets.
void check_provable(const Scene& scene);

/// Throws Error: as check_provable(); exit 130 soon after `stop` is set. `report`: samples done and to do.
Certificate certificate_of(const Scene& scene, double radius, int jobs, const std::atomic<bool>& stop,
                           const std::function<void(long, long)>& report = {});

/// The radii of side a at all samples with so many bits, rad; NaN where nothing is proved.
std::vector<double> certified_radii(const Scene& scene, int bits, const std::atomic<bool>& stop);

/// The results in sentences.
std::vector<std::string> certificate_words(const Scene& scene, const Certificate& proved);

Json certificate_json(const Scene& scene, const Certificate& proved);

}  // namespace doppel

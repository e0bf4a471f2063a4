#pragma once

#include "analysis/certified_pair.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace doppel {

/// By which a run has left the true motion, rad.
inline constexpr double usual_run_radius = 0.5;

/// Throws Error (exit 2) unless the sides are two ideal links, with or without droplets.
void check_provable(const Scene& scene);

/// What is proved about a scene. `report`: samples done and to do. Throws Error: as check_provable(); exit 130 soon
/// after `stop` is set.
Certificate certificate_of(const Scene& scene, double radius, int jobs, const std::atomic<bool>& stop,
                           const std::function<void(long, long)>& report = {});

/// The radii of side a at all samples with so many bits, rad; NaN where nothing is proved.
std::vector<double> certified_radii(const Scene& scene, int bits, const std::atomic<bool>& stop);

/// The results in sentences.
std::vector<std::string> certificate_words(const Scene& scene, const Certificate& proved);

Json certificate_json(const Scene& scene, const Certificate& proved);

}  // namespace doppel

#pragma once

#include "scene/scene.hpp"

#include <atomic>

namespace doppel {

/// What simulating a scene takes, by the beginning of its run.
struct SimulationEstimate {
    double seconds = 0;
    double steps = 0;
    bool at_least = false;  // where the beginning was too brief
};

/// Throws as a run does; exit 130 soon after `stop` is set.
SimulationEstimate estimated_simulation(const Scene& scene, const std::atomic<bool>& stop);

/// What rendering it takes, s: some frames are drawn and written, in a folder that is removed, for about a second. Throws
/// as run() does, as where nothing can draw here.
double estimated_render(const Scene& scene, const SimulationEstimate& simulation, const std::atomic<bool>& stop);

}  // namespace doppel

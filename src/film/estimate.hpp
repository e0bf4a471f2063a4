#pragma once

#include "base/machine.hpp"
#include "scene/scene.hpp"

#include <atomic>

namespace doppel {

/// The time to simulate a scene, extrapolated from the beginning of its run.
struct SimulationEstimate {
    double seconds = 0;  // of one core
    double steps = 0;
    bool at_least = false;  // the beginning was too short for an estimate: a lower bound
};

/// Throws as a run does; exit 130 soon after `stop` is set.
SimulationEstimate estimated_simulation(const Scene& scene, const std::atomic<bool>& stop);

/// What it takes to render a scene; each shard simulates the motion again. The process's memory counts from
/// reset_peak_memory() on. Draws and writes some frames in a temporary folder, for about a second. Throws as run()
/// does, for example if there is no OpenGL.
Needs estimated_render(const Scene& scene, const SimulationEstimate& simulation, const std::atomic<bool>& stop);

}  // namespace doppel

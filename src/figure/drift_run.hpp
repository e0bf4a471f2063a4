#pragma once

#include "scene/preset.hpp"
#include "scene/scene.hpp"

#include <atomic>
#include <vector>

namespace doppel {

/// A method at work on one of the models it serves.
struct DriftMethod {
    std::string name;
    Model model = Model::angles;
    bool projected = false;  // onto the constraints, after every step
};

/// A release followed for a long time, at a given cost.
struct DriftSpec {
    SideSpec release;
    double evaluations_per_s = 500;  // of the right-hand side, a second of motion
    std::vector<double> times_s;     // of the points, rising; the last is the end
};

/// What became of energy and rods.
struct DriftRun {
    double setting = 0;            // step, s, or tolerance
    double evaluations_per_s = 0;  // as it came out
    double cpu_s = 0;
    double broken_at_s = 0;  // NaN where it never was
    // the worst since the point before; NaN where there was no look
    std::vector<double> energy_error, length_error;  // relative (analysis/difference.hpp); m
};

/// The method as fine as the cost allows, until it breaks down: until a step cannot be made, the energy is off by as
/// much as there is, or a rod by the length of the shortest. Steps are a whole part of 100 s, tolerances have three
/// digits; where even the finest tolerance costs less, it is that. Sampling costs an embedded pair some evaluations,
/// which count.
DriftRun drift(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop);

}  // namespace doppel

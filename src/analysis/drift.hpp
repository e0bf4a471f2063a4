#pragma once

#include "integrate/motion.hpp"

#include <span>
#include <string_view>

namespace doppel {

/// A method on one of the models it serves.
struct DriftMethod {
    std::string name;
    Model model = Model::angles;
    bool projected = false;  // onto the constraints, after every step
};

/// A release followed for a long time, at a given cost.
struct DriftSpec {
    Pendulum<Quad> release;
    double evaluations_per_s = 500;  // of the right-hand side, a second of motion
    std::vector<double> times_s;     // of the points, rising; the last is the end
};

/// The errors of energy and rods.
struct DriftRun {
    double setting = 0;            // step, s, or tolerance
    double evaluations_per_s = 0;  // as it came out
    double cpu_s = 0;
    double broken_at_s = 0;  // NaN without a breakdown
    // the worst since the point before; NaN where there was no sample
    std::vector<double> energy_error, length_error;  // relative (analysis/breakdown.hpp); m
};

/// The method as fine as the cost allows, until it breaks down: until a step cannot be made, the energy is off by as
/// much as there is, or a rod by the length of the shortest. Steps are a whole part of 100 s, tolerances have three
/// digits; where even the finest tolerance costs less, it is that. Sampling costs an embedded pair some evaluations,
/// which count. Throws Error (exit 130) soon after `stop` is set.
DriftRun drift(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop);

/// How an error grows in time.
struct Growth {
    enum class Kind { bounded, root, linear, steeper, breakdown };
    Kind kind = Kind::bounded;
    double exponent = 0;     // of t, fitted to the last two decades; 0 where there is nothing to fit
    double doubling_s = 0;   // just before a breakdown; NaN without one, or where it comes at once
    double broken_at_s = 0;  // NaN without a breakdown
};

/// From the errors at rising times, s; NaN and 0 do not count. `broken_at_s` = when the method broke down, or NaN.
Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double broken_at_s);

}  // namespace doppel

#pragma once

#include "integrate/motion.hpp"

#include <cmath>
#include <span>

namespace doppel {

struct DriftCost {
    double setting = 0;            // step, s, or tolerance
    double evaluations_per_s = 0;  // of the right-hand side, a second of motion
    double cpu_s = 0;
    double failed_at_s = NAN;  // NaN without a failure
};

/// A motion followed for a long time, and the errors of its energy and rods.
struct DriftRun : DriftCost {
    // the worst since the point before; NaN where there was no sample
    std::vector<double> energy_error, length_error;  // relative (analysis/watched_motion.hpp); m
};

/// The chain of `motion` by its method and model (and stabilisation), as fine as `evaluations_per_s` allow, to the last of
/// the rising `times_s`; the points are there. A run ends where it fails: where a step cannot be made, the energy is
/// off by as much as there is, or a rod by the length of the shortest. Steps are a whole part of 100 s, tolerances have
/// three digits; where even the finest tolerance costs less, it is that. Sampling costs an embedded pair some evaluations,
/// which count. Throws Error (exit 130) soon after `stop` is set.
DriftRun drift(MotionSpec motion, double evaluations_per_s, std::span<const double> times_s,
               const std::atomic<bool>& stop);

/// How an error grows in time.
struct Growth {
    enum class Kind { bounded, root, linear, steeper, failed };
    Kind kind = Kind::bounded;
    double exponent = 0;      // of t, fitted to the last two decades; 0 where there is nothing to fit
    double doubling_s = NAN;  // just before a failure; NaN without one, or where it comes at once
};

/// From the errors at rising times, s; NaN and 0 do not count. `failed_at_s` = when the method failed, or NaN.
Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double failed_at_s);

}  // namespace doppel

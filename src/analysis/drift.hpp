#pragma once

#include "integrate/motion.hpp"

#include <cmath>
#include <span>

namespace doppel {

struct DriftCost {
    double setting = 0;            // step size, s, or tolerance
    double evaluations_per_s = 0;  // of the right-hand side, per second of motion
    double failed_at_s = NAN;      // NaN if it did not fail
};

/// A long run, and its errors at all points: those of the energy, relative (analysis/watched_motion.hpp), then those of rod
/// lengths, m. Each is the maximum since the previous point; NaN if there was no sample.
struct DriftRun : DriftCost {
    std::vector<double> errors;
};

/// The longest motion over which a setting is tried, s.
inline constexpr double calibration_s = 200;

/// Integrates `motion` by its method, model and stabilisation, at the finest setting that `evaluations_per_s` allow.
/// The points are at the ascending `times_s`; the last one is the end. The run ends if it fails: a step cannot be made,
/// the energy error reaches the total energy, or a rod error reaches the shortest rod. Step sizes are 100 s divided by
/// a whole number; tolerances have three digits. If even the finest tolerance costs less, it is used. Evaluations for
/// sampling an embedded pair are included. Throws Error (exit 130) soon after `stop` is set.
DriftRun drift(MotionSpec motion, double evaluations_per_s, std::span<const double> times_s,
               const std::atomic<bool>& stop);

/// The growth law of an error in time.
struct Growth {
    enum class Kind { bounded, root, linear, steeper, unsteady, failed };  // unsteady: by no power of t
    Kind kind = Kind::bounded;
    double exponent = 0;  // power of t, fitted to the last two decades; 0 without data
};

/// From the errors at ascending times, s; NaN and 0 are ignored. `failed_at_s` = time of the failure, or NaN.
Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double failed_at_s);

}  // namespace doppel

#pragma once

#include "integrate/motion.hpp"

#include <cmath>

namespace doppel {

/// Scales for the errors of energy and rods, by which a failed run is recognised.
struct ErrorScale {
    /// The unit of relative energy errors, J: |E0|, or the potential range if E0 is zero (that is, below the rounding
    /// of initial angles in degrees: cos 90° is 6e-17 in double).
    double energy = 1;
    double gain = 0;   // J, ten times the total energy; no correct motion gains that
    double reach = 0;  // m, length of all rods; no correct motion has such a length error

    ErrorScale(const Observation& start, double potential_range, double whole_reach)
        : energy(std::abs(start.energy) > 1e-13 * potential_range ? std::abs(start.energy) : potential_range),
          gain(10 * (potential_range + std::abs(start.energy) + start.kinetic_energy)),
          reach(whole_reach) {}

    double energy_error(const Observation& seen) const { return std::abs(seen.energy_change / energy); }
    bool is_plausible(const Observation& seen) const {
        return std::isfinite(seen.energy_change) && seen.energy_change <= gain && seen.length_error <= reach;
    }
};

/// Advances to the next sample. Returns false, with the reason, if a step cannot be made. Throws Error (exit 130) soon
/// after `stop` is set.
bool advanced(Motion& motion, const std::atomic<bool>& stop, std::string* why = nullptr);

/// A motion whose errors are checked at every sample.
struct WatchedMotion {
    std::unique_ptr<Motion> motion;
    ErrorScale proportion;
    double energy_error = 0, length_error = 0;  // at the last sample: relative; m

    /// `potential_range`, J, and `reach`, m, as in ErrorScale.
    WatchedMotion(const MotionSpec& spec, double potential_range, double reach)
        : motion(make_motion(spec)), proportion(motion->observe(), potential_range, reach) {}

    /// Advances to the next sample. Returns false if the method fails. Errors: those of advanced().
    bool advance(const std::atomic<bool>& stop);
    double evaluations() const { return static_cast<double>(motion->effort().evaluations); }
};

}  // namespace doppel

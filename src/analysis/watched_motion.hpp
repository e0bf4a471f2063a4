#pragma once

#include "integrate/motion.hpp"

#include <cmath>

namespace doppel {

/// What the energy and the rods of a motion are measured by, so that a failed run is recognised.
struct ErrorScale {
    /// What an energy error is a fraction of, J: |E0|, or the potential range where E0 is zero (below the rounding of a
    /// start that is given in degrees: cos 90° is 6e-17 in double).
    double energy = 1;
    double gain = 0;   // J, ten times all the energy there is: no true motion gains that
    double reach = 0;  // m, of all rods: no true one is off by that

    ErrorScale(const Observation& start, double potential_range, double whole_reach)
        : energy(std::abs(start.energy) > 1e-13 * potential_range ? std::abs(start.energy) : potential_range),
          gain(10 * (potential_range + std::abs(start.energy) + start.kinetic_energy)),
          reach(whole_reach) {}

    double energy_error(const Observation& seen) const { return std::abs(seen.energy_change / energy); }
    bool holds(const Observation& seen) const {
        return std::isfinite(seen.energy_change) && seen.energy_change <= gain && seen.length_error <= reach;
    }
};

/// On to the next sample. False, with the reason, where a step cannot be made. Throws Error (exit 130) soon after `stop` is
/// set.
bool advanced(Motion& motion, const std::atomic<bool>& stop, std::string* why = nullptr);

/// A motion whose errors are watched from sample to sample.
struct WatchedMotion {
    std::unique_ptr<Motion> motion;
    ErrorScale proportion;
    double energy_error = 0, length_error = 0;  // at the last sample: relative; m

    /// `potential_range`, J, and `reach`, m, as ErrorScale has them.
    WatchedMotion(const MotionSpec& spec, double potential_range, double reach)
        : motion(make_motion(spec)), proportion(motion->observe(), potential_range, reach) {}

    /// On to the next sample. False where the method fails. Errors: those of advanced().
    bool advance(const std::atomic<bool>& stop);
    double evaluations() const { return static_cast<double>(motion->effort().evaluations); }
};

}  // namespace doppel

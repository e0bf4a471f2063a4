#pragma once

#include "physics/pendulum.hpp"

#include <cmath>

namespace doppel {

/// What an energy error is a fraction of: |E0|, or the potential range where E0 is zero (below the rounding of a start
/// that is given in degrees: cos 90° is 6e-17 in double).
inline double energy_scale(double start_energy, const Pendulum& pendulum) {
    const double range = pendulum.potential_range();
    return std::abs(start_energy) > 1e-13 * range ? std::abs(start_energy) : range;
}

}  // namespace doppel

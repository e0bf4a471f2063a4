#pragma once

#include <cmath>

namespace doppel {

/// What an energy error is a fraction of, J: |E0|, or the potential range where E0 is zero (below the rounding of a
/// start that is given in degrees: cos 90° is 6e-17 in double).
inline double energy_scale(double start_energy, double potential_range) {
    return std::abs(start_energy) > 1e-13 * potential_range ? std::abs(start_energy) : potential_range;
}

}  // namespace doppel

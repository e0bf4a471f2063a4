#pragma once

#include "fit/parameters.hpp"
#include "physics/physical_pendulum.hpp"

#include <string>

namespace doppel {

/// What angles do not tell, and so has to be given.
struct Convention {
    double gravity = 9.8;      // m/s², > 0
    double second_mass = 1.0;  // kg, > 0
};

/// A pendulum that moves as the fitted arms do. Lengths of the first arm follow from gravity (L1 = g C/D2); how the rest is
/// shared out among mass, centre and inertia no angle tells: both arms are uniform rods (I = m a²/3, a to the centre of
/// mass), or, where point masses were fitted, points at their ends (I = 0). A second arm too light in its first for that
/// is given less inertia.
struct FittedPendulum {
    PhysicalPendulum<double> body;
    double second_inertia = 0;  // B, kg m², by which ratios become these
    std::string rule;           // the sentence above, as it applied
};
FittedPendulum fitted_pendulum(const Parameters& parameters, const ModelSpec& model, const Convention& convention);

}  // namespace doppel

#pragma once

#include "track/model.hpp"

#include <array>
#include <string>

namespace doppel {

/// What angles do not tell, and so has to be given.
struct Convention {
    double gravity = 9.8;      // m/s², > 0
    double second_mass = 1.0;  // kg, > 0
};

/// Arms that move as fitted ones do. Lengths of the first arm follow from gravity (L1 = g C/D2); how the rest is shared
/// out among mass, centre and inertia no angle tells: both arms are uniform rods (I = m a²/3, a to the centre of mass),
/// or, where point masses were fitted, points at their ends (I = 0). A second arm too light in its first for that is
/// given less inertia.
struct FittedPendulum {
    double gravity = 0;
    std::array<double, 2> mass{}, length{}, center{}, inertia{};  // kg, m, m from the joint, kg m² about the centre
    std::array<double, 2> viscous{}, coulomb{};                   // of the joints, N m s and N m
    std::array<double, 2> quadratic{};                            // of the arms, N m s²
    double second_inertia = 0;                                    // B, kg m², by which ratios become these
    std::string rule;                                             // the sentence above, as it applied
};
FittedPendulum fitted_pendulum(const Parameters& parameters, bool point_masses, const Convention& convention);

/// A, B, C, D1, D2 of it over B: the way back.
Parameters ratios_of(const FittedPendulum& pendulum);

}  // namespace doppel

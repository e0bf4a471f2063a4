#include "fit/physical.hpp"

#include <algorithm>

namespace doppel {

FittedPendulum fitted_pendulum(const Parameters& parameters, bool point_masses, const Convention& convention) {
    const auto of = [&](FitParameter parameter) { return parameters[index_of(parameter)]; };
    const double a = of(FitParameter::inertia), c = of(FitParameter::coupling);
    const double d1 = of(FitParameter::gravity_1), d2 = of(FitParameter::gravity_2);
    FittedPendulum pendulum{.gravity = convention.gravity};
    auto& [m1, m2] = pendulum.mass;
    auto& [a1, a2] = pendulum.center;
    auto& [i1, i2] = pendulum.inertia;
    m2 = convention.second_mass;
    // the second arm: B = (1 + share) m2 a2², and g/d2 = B/(m2 a2); the rest of A and D1 must stay positive
    constexpr double of_rod = 1.0 / 3;
    const double room = std::min(a / (c * c) - 1, d1 / (c * d2) - 1);
    const double share = point_masses ? 0 : std::clamp(0.5 * room, 0.0, of_rod);
    a2 = pendulum.gravity / d2 / (1 + share);
    i2 = share * m2 * a2 * a2;
    const double b = i2 + m2 * a2 * a2, first = c * pendulum.gravity / d2;
    pendulum.second_inertia = b;
    pendulum.length = {first, (point_masses ? 1 : 2) * a2};
    // the first: I1 + m1 a1² and m1 a1 are left
    const double inertia = a * b - m2 * first * first, moment = d1 * b / pendulum.gravity - m2 * first;
    if (point_masses) {
        m1 = moment / first, a1 = first, i1 = 0;
    } else {
        a1 = inertia / ((1 + of_rod) * moment);
        m1 = moment / a1;
        i1 = of_rod * m1 * a1 * a1;
    }
    pendulum.viscous = {b * of(FitParameter::viscous_1), b * of(FitParameter::viscous_2)};
    pendulum.coulomb = {b * of(FitParameter::coulomb_1), b * of(FitParameter::coulomb_2)};
    pendulum.quadratic = {b * of(FitParameter::quadratic_1), b * of(FitParameter::quadratic_2)};
    pendulum.rule = point_masses ? "points at the ends of massless rods"
                    : share == of_rod
                        ? "each arm a uniform rod about its own centre of mass"
                        : "the second arm more compact than a rod, as the first leaves it no more inertia";
    return pendulum;
}

Parameters ratios_of(const FittedPendulum& pendulum) {
    const auto& [m1, m2] = pendulum.mass;
    const auto& [a1, a2] = pendulum.center;
    const auto& [i1, i2] = pendulum.inertia;
    const double first = pendulum.length[0], b = i2 + m2 * a2 * a2;
    Parameters p{};
    const auto set = [&](FitParameter parameter, double value) { p[index_of(parameter)] = value / b; };
    set(FitParameter::inertia, i1 + m1 * a1 * a1 + m2 * first * first);
    set(FitParameter::coupling, m2 * first * a2);
    set(FitParameter::gravity_1, (m1 * a1 + m2 * first) * pendulum.gravity);
    set(FitParameter::gravity_2, m2 * a2 * pendulum.gravity);
    set(FitParameter::viscous_1, pendulum.viscous[0]);
    set(FitParameter::viscous_2, pendulum.viscous[1]);
    set(FitParameter::coulomb_1, pendulum.coulomb[0]);
    set(FitParameter::coulomb_2, pendulum.coulomb[1]);
    set(FitParameter::quadratic_1, pendulum.quadratic[0]);
    set(FitParameter::quadratic_2, pendulum.quadratic[1]);
    p[index_of(FitParameter::scale_1)] = p[index_of(FitParameter::scale_2)] = 1;
    return p;
}

}  // namespace doppel

#include "fit/physical.hpp"

#include <algorithm>

namespace doppel {

FittedPendulum fitted_pendulum(const Parameters& parameters, const ModelSpec& model, const Convention& convention) {
    using enum FitParameter;
    const auto of = [&](FitParameter parameter) { return parameters[index_of(parameter)]; };
    const double a = of(inertia), c = of(coupling), d1 = of(gravity_1), d2 = of(gravity_2), g = convention.gravity;
    const double m2 = convention.second_mass;
    // the second arm: B = (1 + share) m2 a2², and g/d2 = B/(m2 a2); the rest of A and D1 must stay positive
    constexpr double of_rod = 1.0 / 3;
    const double room = std::min(a / (c * c) - 1, d1 / (c * d2) - 1);
    const double share = model.point_masses ? 0 : std::clamp(0.5 * room, 0.0, of_rod);
    const double a2 = g / d2 / (1 + share), i2 = share * m2 * a2 * a2, b = i2 + m2 * a2 * a2, l1 = c * g / d2;
    // the first: J = I1 + m1 a1² and m1 a1 are left
    const double second = a * b - m2 * l1 * l1, moment = d1 * b / g - m2 * l1;
    const double a1 = model.point_masses ? l1 : second / ((1 + of_rod) * moment), m1 = moment / a1;
    PhysicalPendulum<double> body;
    body.chain = {.mass = {m1, m2}, .length = {l1, (model.point_masses ? 1 : 2) * a2}, .gravity = g};
    body.center = {a1, a2};
    body.inertia = {model.point_masses ? 0 : of_rod * m1 * a1 * a1, i2};
    const auto friction = [&](FitParameter first, FitParameter other) {
        return std::vector{b * of(first), b * of(other)};
    };
    body.friction.viscous = friction(viscous_1, viscous_2);
    body.friction.coulomb = friction(coulomb_1, coulomb_2);
    (model.drag == Drag::own ? body.friction.arm_quadratic : body.friction.air_quadratic) =
        friction(quadratic_1, quadratic_2);
    return {body, b,
            model.point_masses ? "points at the ends of massless rods"
            : share == of_rod  ? "each arm a uniform rod about its own centre of mass"
                               : "the second arm more compact than a rod, as the first leaves it no more inertia"};
}

}  // namespace doppel

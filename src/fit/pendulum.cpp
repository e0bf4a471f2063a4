#include "fit/pendulum.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The torque over B that holds a joint at rest, > 0 against forward motion.
double holding_torque(const LinkPair<double>& links, std::size_t joint, const LinkState& y) {
    const auto sides = links.sides(y[0], y[1], y[2], y[3]);
    const auto alpha = links.accelerations(sides);
    const double middle = sides.r2 - sides.cosine * alpha[0] - alpha[1];
    return joint == 1 ? middle : sides.r1 - links.p[inertia] * alpha[0] - sides.cosine * alpha[1] + middle;
}

double max_holding_torque(const LinkPair<double>& links, std::size_t joint) {
    constexpr double rounding = 1e-12;
    return links.p[coulomb_1 + joint] * (1 + rounding);
}

}  // namespace

ModelSpec model_of(bool point, int friction, Drag drag, int reading) {
    ModelSpec model{.point_masses = point, .drag = drag};
    for (std::size_t k = 0; k < parameter_count; ++k)
        model.fitted[k] = k < viscous_1  ? k != gravity_1 || !point
                          : k < offset_1 ? k < viscous_1 + static_cast<std::size_t>(2 * friction)
                          : k < lag      ? true
                                         : reading > (k == lag ? 0 : 1);
    return model;
}

double margin(const LinkPair<double>& links, std::size_t joint, const LinkState& y) {
    if (links.modes[joint] == 0) return max_holding_torque(links, joint) - std::abs(holding_torque(links, joint, y));
    return links.modes[joint] * (joint == 0 ? y[2] : y[3] - y[2]);
}

std::array<int, 2> modes_after_event(LinkPair<double> links, std::size_t joint, const LinkState& y) {
    const bool was_held = std::exchange(links.modes[joint], 0) == 0;
    const double torque = holding_torque(links, joint, y);
    if (was_held || std::abs(torque) > max_holding_torque(links, joint)) links.modes[joint] = torque < 0 ? -1 : 1;
    return links.modes;
}

FittedPendulum fitted_pendulum(const Parameters& p, const ModelSpec& model, const Convention& convention) {
    const double a = p[inertia], c = p[coupling], d1 = p[gravity_1], d2 = p[gravity_2], g = convention.gravity;
    const double m2 = convention.second_mass;
    // the second link: B = (1 + share) m2 a2², and g/d2 = B/(m2 a2); the remainders of A and D1 must stay positive
    constexpr double of_rod = 1.0 / 3;
    const double room = std::min(a / (c * c) - 1, d1 / (c * d2) - 1);
    const double share = model.point_masses ? 0 : std::clamp(0.5 * room, 0.0, of_rod);
    const double a2 = g / d2 / (1 + share), i2 = share * m2 * a2 * a2, b = i2 + m2 * a2 * a2, l1 = c * g / d2;
    // the first link: J = I1 + m1 a1² and m1 a1 are the remainders
    const double second = a * b - m2 * l1 * l1, moment = d1 * b / g - m2 * l1;
    const double a1 = model.point_masses ? l1 : second / ((1 + of_rod) * moment), m1 = moment / a1;
    const auto friction = [&](std::size_t first) { return std::array{b * p[first], b * p[first + 1]}; };
    return {.links = {{"mass_kg", {m1, m2}},
                      {"length_m", {l1, (model.point_masses ? 1 : 2) * a2}},
                      {"center_m", {a1, a2}},
                      {"inertia_kg_m2", {model.point_masses ? 0 : of_rod * m1 * a1 * a1, i2}},
                      {"joint_viscous_N_m_s", friction(viscous_1)},
                      {"joint_coulomb_N_m", friction(coulomb_1)},
                      {model.drag == Drag::own ? "arm_drag_quadratic_N_m_s2" : "air_drag_quadratic_N_m_s2",
                       friction(quadratic_1)}},
            .gravity = g,
            .second_inertia = b,
            .rule = model.point_masses ? "points at the ends of massless rods"
                    : share == of_rod
                        ? "each link a uniform rod about its own centre of mass"
                        : "the second link more compact than a uniform rod, because the first leaves it less inertia"};
}

}  // namespace doppel

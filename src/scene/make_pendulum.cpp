#include "scene/scene.hpp"

#include <algorithm>
#include <vector>

namespace doppel {

Pendulum<Quad> chain_of(const SideSpec& spec) {
    Pendulum<Quad> chain{spec.mass_kg, spec.length_m, {}, {}, spec.gravity_m_per_s2};
    for (std::size_t i = 0; i < chain.links(); ++i) chain.mass[i] += spec.physical.rod_mass_kg[i];
    const Quad degree = pi_of<Quad>() / 180;
    for (const auto& angle : spec.angle_deg) chain.angle.push_back(angle * degree);
    for (const auto& rate : spec.omega_deg_per_s) chain.rate.push_back(rate * degree);
    return chain;
}

PhysicalPendulum<Quad> physical_of(const SideSpec& spec) {
    const auto& from = spec.physical;
    const Quad degree = pi_of<Quad>() / 180, turn = 2 * pi_of<Quad>();
    auto made = doppel::physical(chain_of(spec));
    for (std::size_t i = 0; i < made.chain.links(); ++i) {
        // body and rod as one rigid body, about their common centre of mass
        const auto &body = spec.mass_kg[i], &rod = from.rod_mass_kg[i], &length = spec.length_m[i];
        const Quad at = from.center_m.empty() ? length : from.center_m[i], middle = length / 2;
        const Quad center = (body * at + rod * middle) / (body + rod);
        made.center[i] = center;
        made.inertia[i] = from.inertia_kg_m2[i] + body * (at - center) * (at - center) + rod * length * length / 12 +
                          rod * (middle - center) * (middle - center);
    }
    const auto given = [](const std::vector<Quad>& list) { return is_zero(list) ? std::vector<Quad>() : list; };
    made.friction = {given(from.joint_viscous_N_m_s),       given(from.joint_coulomb_N_m),
                     given(from.arm_drag_linear_N_m_s),     given(from.arm_drag_quadratic_N_m_s2),
                     given(from.air_drag_quadratic_N_m_s2), given(from.drag_linear_N_s_per_m),
                     given(from.drag_quadratic_N_s2_per_m2)};
    if (from.pivot.amplitude_m != 0) {
        const SinCos<Quad> direction(Quad(from.pivot.direction_deg * degree));
        made.pivot = {from.pivot.amplitude_m * direction.cos, from.pivot.amplitude_m * direction.sin,
                      from.pivot.frequency_hz * turn, from.pivot.phase_deg * degree};
    }
    for (const auto& motor : from.torques)
        made.torques.push_back({static_cast<std::size_t>(motor.joint) - 1, motor.amplitude_N_m,
                                motor.frequency_hz * turn, motor.phase_deg * degree});
    return made;
}

bool differ_in_numbers_only(const PhysicalSpec& one, const PhysicalSpec& other) {
    const auto same_joint = [](const TorqueSpec& a, const TorqueSpec& b) { return a.joint == b.joint; };
    return one.center_m.empty() == other.center_m.empty() &&
           std::equal(one.torques.begin(), one.torques.end(), other.torques.begin(), other.torques.end(), same_joint);
}

}  // namespace doppel

#pragma once

#include "scene/field.hpp"
#include "scene/preset.hpp"

#include <algorithm>
#include <string_view>
#include <type_traits>

namespace doppel {

// The keys of chains that are more than point masses, as in scene/preset_fields.hpp.

inline constexpr double most_hz = 1e6;  // of a drive: far above what a pendulum follows

/// [system.pivot]
template <class Visit, class Pivot>
void pivot_fields(Visit& visit, Pivot& pivot) {
    visit({"direction_deg", "of the motion, from the x axis: 90 = up", "deg", angle_bounds}, pivot.direction_deg);
    visit({"amplitude_m", "half the way to and fro; 0 = the pivot stays where it is", "m", not_negative},
          pivot.amplitude_m);
    visit({"frequency_hz", "swings a second", "Hz", {.low = 0, .high = most_hz, .is_open = true}}, pivot.frequency_hz);
    visit({"phase_deg", "of the cosine at t = 0", "deg", angle_bounds}, pivot.phase_deg);
}

/// [[system.torque]], without `name`.
template <class Visit, class Torque>
void part_fields(Visit& visit, Torque& torque) requires std::is_same_v<std::remove_const_t<Torque>, TorqueSpec> {
    visit({"joint", "where: 1 is the pivot, 2 the end of link 1; the link above takes the opposite", "",
           from_to(1, 10'000)},
          torque.joint);
    visit({"amplitude_N_m", "torque", "N m"}, torque.amplitude_N_m);
    visit({"frequency_hz", "swings a second", "Hz", from_to(0, most_hz)}, torque.frequency_hz);
    visit({"phase_deg", "of the cosine at t = 0", "deg", angle_bounds}, torque.phase_deg);
}

/// What a real chain has besides, but torques.
template <class Visit, class Physical>
void physical_fields(Visit& visit, Physical& physical) {
    const auto list = [&](std::string_view key, std::string_view caption, std::string_view help, std::string_view unit,
                          auto& values) {
        visit({.key = key,
               .help = help,
               .unit = unit,
               .bounds = not_negative,
               .only = {.holds = !is_zero(values)},
               .each = "one a link",
               .caption = caption},
              values);
    };
    list("rod_mass_kg", "", "mass of each rod, evenly along it, besides mass_kg", "kg", physical.rod_mass_kg);
    visit({.key = "center_m",
           .help = "of a link whose mass_kg is a body: from its joint to the centre of mass",
           .unit = "m",
           .bounds = not_negative,
           .absent = "at the end",
           .only = {.holds = !physical.center_m.empty()},
           .each = "one a link",
           .caption = "centre of mass"},
          physical.center_m);
    list("inertia_kg_m2", "", "of such a body, about its centre of mass", "kg m²", physical.inertia_kg_m2);
    list("joint_viscous_N_m_s", "viscous friction", "friction at each joint, by its rate", "N m s",
         physical.joint_viscous_N_m_s);
    list("joint_coulomb_N_m", "Coulomb friction", "friction at each joint, whatever its rate (Coulomb)", "N m",
         physical.joint_coulomb_N_m);
    visit({"joint_coulomb_width_deg_per_s", "has no effect any more: a joint comes to rest where its rate is 0",
           "deg/s", positive},
          physical.joint_coulomb_width_deg_per_s);
    list("arm_drag_linear_N_m_s", "linear drag on arms", "drag on each link, by its own rate", "N m s",
         physical.arm_drag_linear_N_m_s);
    list("arm_drag_quadratic_N_m_s2", "drag on arms", "the same, by the square of its rate", "N m s²",
         physical.arm_drag_quadratic_N_m_s2);
    list("air_drag_quadratic_N_m_s2", "air drag",
         "drag on each link, by the square of the rate with which its centre of oscillation meets the air broadside",
         "N m s²", physical.air_drag_quadratic_N_m_s2);
    list("drag_linear_N_s_per_m", "linear drag", "drag on each end of a link, by its speed", "N s/m",
         physical.drag_linear_N_s_per_m);
    list("drag_quadratic_N_s2_per_m2", "quadratic drag", "the same, by the square of its speed", "N s²/m²",
         physical.drag_quadratic_N_s2_per_m2);
    visit.table("pivot", [&](auto& table) { pivot_fields(table, physical.pivot); });
}

}  // namespace doppel

#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

std::string physical_words(const PhysicalSpec& physical) {
    std::vector<std::string> words;
    const auto has = [](const std::vector<Quad>& list) { return !is_zero(list); };
    if (has(physical.rod_mass_kg) || has(physical.inertia_kg_m2) || !physical.center_m.empty())
        words.push_back("heavy links");
    if (has(physical.joint_viscous_N_m_s) || has(physical.joint_coulomb_N_m)) words.push_back("friction");
    if (has(physical.arm_drag_linear_N_m_s) || has(physical.arm_drag_quadratic_N_m_s2) ||
        has(physical.air_drag_quadratic_N_m_s2) || has(physical.drag_linear_N_s_per_m) ||
        has(physical.drag_quadratic_N_s2_per_m2))
        words.push_back("drag");
    if (physical.pivot.amplitude_m != 0) words.push_back("a moving pivot");
    if (!physical.torques.empty()) words.push_back("motors");
    return fmt::format("{}", fmt::join(words, ", "));
}

std::vector<std::string> physical_differences(const PhysicalSpec& one, const PhysicalSpec& other) {
    std::vector<std::string> all;
    const auto say = [&](std::string_view name, const std::vector<Quad>& values, const std::vector<Quad>& others,
                         std::string_view unit) {
        if (values == others) return;
        if (is_zero(values)) return all.push_back(fmt::format("no {}", name));
        constexpr std::size_t most_listed = 3;
        if (values.size() > most_listed && values.size() == others.size()) {
            const auto first = std::mismatch(values.begin(), values.end(), others.begin()).first;
            return all.push_back(
                fmt::format("{} of link {} {} {}", name, first - values.begin() + 1, text_of(*first), unit));
        }
        std::vector<std::string> texts;
        for (const auto& value : values) texts.push_back(text_of(value));
        all.push_back(fmt::format("{} {} {}", name, fmt::join(texts, "/"), unit));
    };
    say("rod mass", one.rod_mass_kg, other.rod_mass_kg, "kg");
    say("centre of mass", one.center_m, other.center_m, "m");
    say("inertia", one.inertia_kg_m2, other.inertia_kg_m2, "kg m²");
    say("viscous friction", one.joint_viscous_N_m_s, other.joint_viscous_N_m_s, "N m s");
    say("Coulomb friction", one.joint_coulomb_N_m, other.joint_coulomb_N_m, "N m");
    say("linear drag on arms", one.arm_drag_linear_N_m_s, other.arm_drag_linear_N_m_s, "N m s");
    say("drag on arms", one.arm_drag_quadratic_N_m_s2, other.arm_drag_quadratic_N_m_s2, "N m s²");
    say("air drag", one.air_drag_quadratic_N_m_s2, other.air_drag_quadratic_N_m_s2, "N m s²");
    say("linear drag", one.drag_linear_N_s_per_m, other.drag_linear_N_s_per_m, "N s/m");
    say("quadratic drag", one.drag_quadratic_N_s2_per_m2, other.drag_quadratic_N_s2_per_m2, "N s²/m²");
    if (one.pivot != other.pivot)
        all.push_back(one.pivot.amplitude_m == 0 ? "pivot at rest"
                                                 : fmt::format("pivot ±{} m at {} Hz", text_of(one.pivot.amplitude_m),
                                                               text_of(one.pivot.frequency_hz)));
    if (one.torques != other.torques) {
        std::vector<std::string> texts;
        for (const auto& motor : one.torques)
            texts.push_back(fmt::format("{} N m at {} Hz", text_of(motor.amplitude_N_m), text_of(motor.frequency_hz)));
        all.push_back(texts.empty() ? "no motor" : fmt::format("motor {}", fmt::join(texts, " and ")));
    }
    return all;
}

}  // namespace doppel

#pragma once

#include "scene/preset.hpp"

#include <optional>
#include <string>
#include <vector>

// What moves in a figure, in the words of its subtitle.

namespace doppel {

/// "a double pendulum"
std::string pendulum_words(std::size_t links);

/// "released at rest from 30°/0°", or "θ₁/0°" where the angle of link `swept`, from 0, is not one.
std::string released_words(const SideSpec& side, std::optional<std::size_t> swept = {});

/// "links of 1 m and 1 kg, g = 9.8 m/s²"; "links of 1, 0.5 m …" where they differ; no masses: not named.
std::string links_words(const std::vector<double>& length_m, const std::vector<double>& mass_kg,
                        double gravity_m_per_s2);
std::string links_words(const SideSpec& side);

/// What moves where the mass ratio, or else the first angle, is not one: "a double pendulum released at rest from θ₁/0°; links
/// of 1 m and 1 kg, g = 9.8 m/s²".
std::string swept_words(const SideSpec& side, bool mass_ratio);

}  // namespace doppel

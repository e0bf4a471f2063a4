#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace doppel {

/// What moves in a figure of pairs, and how it is stepped: "two links in angles, θ₂ = 0, twins 0.003° apart; explicit
/// Euler, 1/30 000 s". What sets the sides apart follows as "m₁ = 1 kg against m₁ = 1.01 kg".
///
/// `swept_angle`  the link, from 0, whose angle of release is not the same in all pairs and so is left out
/// `apart`        what else sets the sides of all pairs apart, "twins 0.003° apart"; then it is not part of `scene`
std::string pair_subtitle(const Scene& scene, std::optional<std::size_t> swept_angle = {},
                          const std::string& apart = "");

/// Whether both sides are released alike: then their distance at the start is 0.
bool released_alike(const SideSpec& a, const SideSpec& b);

}  // namespace doppel

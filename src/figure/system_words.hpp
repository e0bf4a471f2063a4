#pragma once

#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

// What moves in a figure, in the words of its subtitle.

namespace doppel {

/// "a double pendulum"
std::string pendulum_words(std::size_t links);

/// "30°/0°"
std::string slashed(const std::vector<Quad>& numbers, std::string_view unit = "");

/// "released at rest from 30°/0°"
std::string released_words(const SideSpec& side);

/// "links of 1 m and 1 kg, g = 9.8 m/s²"; "links of 1, 0.5 m …" where they differ; no masses: not named.
std::string links_words(const std::vector<double>& length_m, const std::vector<double>& mass_kg,
                        double gravity_m_per_s2);
std::string links_words(const SideSpec& side);

/// What moves in a figure of pairs, and how it is stepped: "two links in angles, θ₂ = 0, pair 0.003° apart; explicit
/// Euler, 1/30 000 s". What sets the sides apart follows as "m₁ = 1 kg against m₁ = 1.01 kg".
///
/// `varied`  what is not the same in all pairs and so is left out
/// `apart`   what else sets the sides of all pairs apart, "pair 0.003° apart"; then it is not part of `scene`
struct Varied {
    std::vector<std::size_t> angles;     // of release: links, from 0
    bool step = false;                   // and how finely to step
    std::vector<std::string> keys = {};  // "system.integrator": whose values are words
    std::string method = {};             // in place of the preset's, where the figure itself steps
};
std::string pair_subtitle(const Scene& scene, const Varied& varied = {}, const std::string& apart = "");

}  // namespace doppel

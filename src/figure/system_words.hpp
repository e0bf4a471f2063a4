#pragma once

#include "scene/scene.hpp"

#include <string>
#include <string_view>
#include <vector>

// The description of the system in a figure's subtitle.

namespace doppel {

/// "30°/0°"
std::string slashed(const std::vector<Quad>& numbers, std::string_view unit = "");

/// For example "released at rest from 30°/0°".
std::string released_words(const SideSpec& side);

/// "links of 1 m and 1 kg, g = 9.8 m/s²", or "links of 1, 0.5 m …" if they differ.
std::string links_words(const SideSpec& side);

/// The system and integrator of a figure of pairs: "two links in angles, θ₂ = 0, pair 0.003° apart; explicit Euler,
/// 1/30 000 s". Other differences between the sides follow as "m₁ = 1 kg against m₁ = 1.01 kg".
///
/// `swept`  what differs between pairs and is left out
/// `difference`   the difference that the figure adds to every pair, "pair 0.003° apart"; it is not part of `scene`
struct SweptKeys {
    std::vector<std::size_t> angles;     // release angles: links, from 0
    bool step = false;                   // also the step size or tolerance
    std::vector<std::string> keys = {};  // with textual values: "system.integrator"
    std::string method = {};             // the method, if the figure chooses it itself
};
std::string pair_subtitle(const Scene& scene, const SweptKeys& swept = {}, const std::string& difference = "");

}  // namespace doppel

#pragma once

#include "scene/scene.hpp"
#include "scene/side_keys.hpp"

#include <array>
#include <string>
#include <string_view>
#include <vector>

// The texts of films and figures that describe a system, its start, its computation, and how two sides differ. They are
// made of the keys of the sides (side_keys.hpp).

namespace doppel {

/// The texts of one side in a picture: `heading`, the difference from the other side; `note`, its start. The preset may
/// replace both.
struct SideCaptions {
    std::string heading, note;
};

/// With symbols and methods, or in plain words: "θ₁ = 90.003°", "90.003°".
enum class Wording { exact, plain };

std::array<SideCaptions, 2> side_captions(const Scene& scene, Wording wording = Wording::exact);

/// The preset's subtitle, or the common properties of both sides: "two double pendulums, released at rest · angles,
/// explicit Euler, 1/30 000 s".
std::string scene_caption(const Scene& scene, Wording wording = Wording::exact);

/// What differs between the pairs of a figure and is left out of its subtitle.
struct SweptKeys {
    std::vector<std::size_t> angles;     // release angles: links, from 0
    bool step = false;                   // also the step size or tolerance
    std::vector<std::string> keys = {};  // "system.integrator"
    std::string method = {};             // the method, if the figure chooses it itself
};
/// The system and method of a figure of pairs: "two links in angles, θ₂ = 0, pair 0.003° apart; explicit Euler,
/// 1/30 000 s". `difference` = what the figure adds to every pair, "pair 0.003° apart"; other differences between the
/// sides follow as "m₁ = 1 kg against m₁ = 1.01 kg".
std::string pair_subtitle(const Scene& scene, const SweptKeys& swept = {}, const std::string& difference = "");

/// "a double pendulum with friction, released at rest from 30°/0°, links of 1 m and 1 kg, g = 9.8 m/s²"
std::string motion_words(const SideSpec& side);
/// "links of 1 m and 1/0.5 kg, g = 9.8 m/s²"
std::string links_words(const SideSpec& side);
/// Properties of a chain that point masses lack: "links with mass, friction"; empty if there are none.
std::string physical_words(const PhysicalSpec& physical);

/// "30°/0°"; the range of long lists that differ, "10° to 60°"; equal numbers only once in these, or if `once` is set.
std::string slashed(const std::vector<Quad>& numbers, std::string_view unit = "", bool once = false);

/// "0.1/0.2 N m s", "(3, 1) m", "90°"; of long lists the beginning.
std::string value_words(const SideKey& key);

/// "1/30 000 s"
std::string step_text(const Rational& step);
/// The step size or tolerance: "1/30 000 s", "tolerance 10⁻¹²".
std::string step_control_text(const Side& side);
/// 0.25 → "0.25", 3e-12 → "3 × 10⁻¹²", 1e-12 → "10⁻¹²".
std::string number_text(const Quad& number);

/// 12 → "₁₂"
std::string subscript(std::size_t number);

/// 30000 → "30 000"
std::string grouped(long number);

/// 223456 → "220 000": two significant digits, as for a single measurement.
std::string two_digits(double value);
/// The same with so many digits: 1234.5 → "1230", 12.345 → "12.3".
std::string with_digits(double value, int digits);

/// 0.0123 → "1.2 × 10⁻²"
std::string scientific(double value);

}  // namespace doppel

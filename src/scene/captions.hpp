#pragma once

#include "scene/scene.hpp"

#include <array>
#include <string>

namespace doppel {

/// "double pendulum", "chain of 4 links"; in the plural "double pendulums".
std::string chain_words(std::size_t links, std::string_view plural = "");
/// Properties of a chain that point masses lack: "links with mass, friction"; empty if there are none.
std::string physical_words(const PhysicalSpec& physical);

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

/// The step size or tolerance: "1/30 000 s", "tolerance 10⁻¹²".
std::string step_control_text(const Side& side);
/// 3e-12 → "3 × 10⁻¹²", 1e-12 → "10⁻¹²".
std::string tolerance_text(const Quad& tolerance);

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

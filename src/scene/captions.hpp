#pragma once

#include "scene/scene.hpp"

#include <array>
#include <string>

namespace doppel {

/// "double pendulum", "chain of 4 links"; of several "double pendulums".
std::string chain_words(std::size_t links, std::string_view plural = "");
/// What a chain has besides point masses: "links with mass, friction"; empty where it has nothing.
std::string physical_words(const PhysicalSpec& physical);

/// What a picture says about one side: `heading`, what differs from the other side; `note`, its start;
/// or what the preset says in their place.
struct SideCaptions {
    std::string heading, note;
};

/// With symbols and methods, or in words for everybody: "θ₁ = 90.003°", "90.003°".
enum class Wording { exact, plain };

std::array<SideCaptions, 2> side_captions(const Scene& scene, Wording wording = Wording::exact);

/// The preset's subtitle, or what both sides have in common: "two double pendulums, released at rest · angles, explicit
/// Euler, 1/30 000 s".
std::string scene_caption(const Scene& scene, Wording wording = Wording::exact);

/// How finely a side is stepped: "1/30 000 s", "tolerance 1e-12".
std::string step_control_text(const Side& side);

/// 12 → "₁₂"
std::string subscript(std::size_t number);

/// 30000 → "30 000"
std::string grouped(long number);

/// 223456 → "220 000": what was measured once knows no more digits.
std::string roughly(double value);

/// 0.0123 → "1.2 × 10⁻²"
std::string scientific(double value);

}  // namespace doppel

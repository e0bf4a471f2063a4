#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

namespace doppel {

/// A colour as screens take it: sRGB, each channel 0…1, `a` = opacity (not premultiplied).
struct Color {
    float r = 0, g = 0, b = 0, a = 1;

    constexpr Color with_alpha(float alpha) const { return {r, g, b, alpha}; }
    friend constexpr bool operator==(const Color&, const Color&) = default;
};

/// A channel as a byte, rounded.
inline std::uint8_t byte_of(double channel) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
}

/// Red, green, blue and opacity as bytes.
inline std::array<std::uint8_t, 4> bytes_of(const Color& color) {
    return {byte_of(color.r), byte_of(color.g), byte_of(color.b), byte_of(color.a)};
}

/// From 0xRRGGBB, opaque.
constexpr Color rgb(unsigned hex) {
    return {static_cast<float>((hex >> 16) & 0xff) / 255.0f, static_cast<float>((hex >> 8) & 0xff) / 255.0f,
            static_cast<float>(hex & 0xff) / 255.0f, 1.0f};
}

/// `share` of b in a.
constexpr Color mixed(Color a, Color b, float share) {
    const auto mix = [share](float x, float y) { return x + share * (y - x); };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), mix(a.a, b.a)};
}

/// From "#rrggbb"; nothing where the text is no such colour.
std::optional<Color> parse_color(std::string_view text);

/// The colour of `share` (0…1, beyond: the nearest end) of a scale: dark violet through blue and green to pale yellow.
///
/// Equal shares look equally far apart: the scale runs through OKLab (Ottosson 2020) at constant speed, and lightness
/// only grows, so that it holds in grey and for the colour-blind. NaN: the lower end.
Color map_color(double share);

}  // namespace doppel

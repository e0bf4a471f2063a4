#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace doppel {

/// An sRGB colour, each channel 0…1; `a` = opacity (not premultiplied).
struct Color {
    float r = 0, g = 0, b = 0, a = 1;

    constexpr Color with_alpha(float alpha) const { return {r, g, b, alpha}; }
    friend constexpr bool operator==(const Color&, const Color&) = default;
};

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

/// Linear interpolation from a (share = 0) to b (share = 1), channel by channel.
constexpr Color mixed(Color a, Color b, float share) {
    const auto mix = [share](float x, float y) { return x + share * (y - x); };
    return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), mix(a.a, b.a)};
}

/// Parses "#rrggbb"; returns nothing for other texts.
std::optional<Color> parse_color(std::string_view text);
/// "#rrggbb"; "#rrggbbaa" if it is not opaque.
std::string hexadecimal(const Color& color);

/// The colour scale of heat maps at `share`, 0…1 (clamped; NaN gives the lower end): dark violet, blue, green, pale
/// yellow. It is perceptually uniform in OKLab (Ottosson 2020), and its lightness increases, so that it can be read in
/// grey and by colour-blind people.
Color map_color(double share);

/// The colours of a picture. Orange and blue of the two sides can be told apart by colour-blind people (Okabe & Ito
/// 2008).
struct Theme {
    std::string_view name;
    Color background, panel;     // of the picture; of the area behind the pendulums
    Color text, quiet_text;      // for important text; for secondary text
    Color grid, frame, cursor;   // lines of a chart: grid, border, current time
    Color rod, bob, pivot;       // common to all pendulums
    std::array<Color, 2> sides;  // of sides A and B
    Color trace;                 // of quantities of the pair
    Color bad, open;             // failed; unknown
    Color none;                  // cells of a map without a value
    float glow;                  // glow radius of trails, px of a 1920×1080 picture; 0 = no glow
    std::array<Color, 8>
        palette;  // colours of curves, beginning with the two sides'; contrast at least 3:1 on the background

    constexpr bool is_dark() const {
        return 0.2126f * background.r + 0.7152f * background.g + 0.0722f * background.b < 0.5f;
    }
};

inline constexpr std::array<Theme, 3> themes{{
    {.name = "dark",
     .background = rgb(0x0b0e13),
     .panel = rgb(0x11151d),
     .text = rgb(0xf1f4f8),
     .quiet_text = rgb(0x98a2b3),
     .grid = rgb(0x222936),
     .frame = rgb(0x2f3846),
     .cursor = rgb(0x8b95a5),
     .rod = rgb(0xc9d1dc),
     .bob = rgb(0xeef1f6),
     .pivot = rgb(0x6f7a8a),
     .sides = {rgb(0xffa640), rgb(0x4fb0ff)},
     .trace = rgb(0xb9f0c0),
     .bad = rgb(0xff7b6b),
     .open = rgb(0xe8c34a),
     .none = rgb(0x3a3f49),
     .glow = 12,
     .palette = {rgb(0xffa640), rgb(0x4fb0ff), rgb(0x69f2d8), rgb(0xe882a8), rgb(0x6f6bea), rgb(0xf4f062),
                 rgb(0x8f9030), rgb(0xa85a92)}},
    {.name = "light",
     .background = rgb(0xffffff),
     .panel = rgb(0xf4f6f9),
     .text = rgb(0x10151d),
     .quiet_text = rgb(0x586273),
     .grid = rgb(0xe2e6ec),
     .frame = rgb(0xc3cad4),
     .cursor = rgb(0x8791a1),
     .rod = rgb(0x4a5464),
     .bob = rgb(0x4a5464),
     .pivot = rgb(0x9aa4b3),
     .sides = {rgb(0xb85200), rgb(0x0068b8)},
     .trace = rgb(0x1b7a3d),
     .bad = rgb(0xb3261e),
     .open = rgb(0x8a6100),
     .none = rgb(0xdde1e7),
     .glow = 0,
     .palette = {rgb(0xb85200), rgb(0x0068b8), rgb(0x2e9398), rgb(0x8e3f7e), rgb(0x1e9a5c), rgb(0x7f7ff5),
                 rgb(0x763423), rgb(0x6133fb)}},
    {.name = "high-contrast",
     .background = rgb(0x000000),
     .panel = rgb(0x000000),
     .text = rgb(0xffffff),
     .quiet_text = rgb(0xdcdcdc),
     .grid = rgb(0x5a5a5a),
     .frame = rgb(0xa0a0a0),
     .cursor = rgb(0xffffff),
     .rod = rgb(0xffffff),
     .bob = rgb(0xffffff),
     .pivot = rgb(0xb4b4b4),
     .sides = {rgb(0xffd000), rgb(0x3fc8ff)},
     .trace = rgb(0x7dff9a),
     .bad = rgb(0xff8a8a),
     .open = rgb(0xffd000),
     .none = rgb(0x5a5a5a),
     .glow = 0,
     .palette = {rgb(0xffd000), rgb(0x3fc8ff), rgb(0xeb1350), rgb(0x9df791), rgb(0x3f6fec), rgb(0xebf4db),
                 rgb(0xc965a5), rgb(0xe06b14)}},
}};

}  // namespace doppel

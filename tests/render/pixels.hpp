#pragma once

#include "image/picture.hpp"
#include "render/renderer.hpp"

#include <cmath>

namespace doppel {

constexpr Color black = rgb(0x000000), white = rgb(0xffffff);

/// Whether each channel is within `slack` levels.
inline bool is_color(const std::uint8_t* pixel, Color color, int slack = 3) {
    const auto near = [&](int found, float wanted) { return std::abs(found - std::lround(255 * wanted)) <= slack; };
    return near(pixel[0], color.r) && near(pixel[1], color.g) && near(pixel[2], color.b);
}

/// A list drawn on black.
inline Picture drawn(Size size, const DisplayList& list) {
    Renderer renderer(size, {filled(size, black)});
    return renderer.draw(list);
}

/// White ink on black: its area, px², and its centre, px.
struct Ink {
    double area = 0, x = 0, y = 0;
};

inline Ink ink(const Picture& picture) {
    Ink sum;
    for (int y = 0; y < picture.size.height; ++y) {
        for (int x = 0; x < picture.size.width; ++x) {
            const double covered = picture.at(x, y)[1] / 255.0;
            sum.area += covered;
            sum.x += covered * (x + 0.5);
            sum.y += covered * (y + 0.5);
        }
    }
    return {sum.area, sum.x / sum.area, sum.y / sum.area};
}

/// The smallest rectangle that contains all ink.
inline Rect extent(const Picture& picture) {
    Rect held;
    for (int y = 0; y < picture.size.height; ++y) {
        for (int x = 0; x < picture.size.width; ++x) {
            if (picture.at(x, y)[1] > 0) held = united(held, {x, y, x + 1, y + 1});
        }
    }
    return held;
}

}  // namespace doppel

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

inline bool is_color(const Picture& picture, Point at, Color color, int slack = 3) {
    return is_color(picture.at(static_cast<int>(at.x), static_cast<int>(at.y)), color, slack);
}

/// Calls visit(x, y) for all pixels.
template <class Visit>
void for_each_pixel(const Rect& area, Visit&& visit) {
    for (int y = area.top; y < area.bottom; ++y)
        for (int x = area.left; x < area.right; ++x) visit(x, y);
}
template <class Visit>
void for_each_pixel(const Picture& picture, Visit&& visit) {
    for_each_pixel(all_of(picture.size), visit);
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
    for_each_pixel(picture, [&](int x, int y) {
        const double covered = picture.at(x, y)[1] / 255.0;
        sum.area += covered;
        sum.x += covered * (x + 0.5);
        sum.y += covered * (y + 0.5);
    });
    return {sum.area, sum.x / sum.area, sum.y / sum.area};
}

/// The smallest rectangle that contains all ink.
inline Rect extent(const Picture& picture) {
    Rect held;
    for_each_pixel(picture, [&](int x, int y) {
        if (picture.at(x, y)[1] > 0) held = united(held, {x, y, x + 1, y + 1});
    });
    return held;
}

}  // namespace doppel

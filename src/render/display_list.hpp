#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {

/// A position in the picture, px from its top left corner; y points down. Pixel centres are at half-integers.
struct Point {
    float x = 0, y = 0;
    friend bool operator==(const Point&, const Point&) = default;
};

inline float distance(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// A filled rectangle with rounded corners. Its edges are exactly at left, top, right, bottom.
struct Box {
    float left = 0, top = 0, right = 0, bottom = 0;  // px
    float corner = 0;                                // radius, px
    Color color;
};

/// A whole picture of one colour.
inline Box filled(Size size, Color color) {
    return {0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, color};
}

/// A line whose edges are at pixel edges, so that it is sharp; at least one pixel wide.
inline Box vertical_line(float x, float top, float bottom, float width, Color color) {
    const float left = std::round(x - width / 2);
    return {left, top, left + std::max(1.0f, std::round(width)), bottom, 0, color};
}
inline Box horizontal_line(float y, float left, float right, float width, Color color) {
    const float top = std::round(y - width / 2);
    return {left, top, right, top + std::max(1.0f, std::round(width)), 0, color};
}

/// All points within `radius` of the segment from…to: a rod, a line, or, if both ends are equal, a disc.
struct Capsule {
    Point from, to;
    float radius = 1;  // px
    Color color;
    float glow = 0;  // width of the soft glow beyond the edge, px; 0 = none
};

/// The outline of a circle, `width` px wide, half of it on either side of `radius`.
struct Ring {
    Point center;
    float radius = 1, width = 1;  // px
    Color color;
};

// GCC 12 reports the moved-from rest of a variant as uninitialised (PR 105562)
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
/// A path whose opacity and width vary along it. At a crossing the more opaque part shows.
struct Stroke {
    struct Vertex {
        Point at;
        float alpha = 1;  // factor of color.a
        float width = 1;  // factor of Stroke::width
        float glow = 1;   // factor of Stroke::glow
        float bend =
            0;  // of the parabola to the next vertex: px right of the chord at its middle, at most 1/16 of its length
        bool joint = false;  // simplification keeps it; two at one place change opacity and width at once
    };
    std::vector<Vertex> vertices;
    float width = 1;  // px
    Color color;
    float glow = 0;  // width of the soft glow beyond the edge, px; 0 = none
};
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

enum class Align { left, center, right };
enum class Weight { regular, bold };

/// One line of text (UTF-8), its baseline at anchor.y, aligned to anchor.x.
struct Label {
    std::string text;
    Point anchor;
    float size = 16;  // px per em
    Align align = Align::left;
    Weight weight = Weight::regular;
    Color color;
};

inline Label label(std::string text, Point anchor, float size, Color color, Align align = Align::left,
                   Weight weight = Weight::regular) {
    return {std::move(text), anchor, size, align, weight, color};
}

/// One thing to draw; lists are in order from back to front.
using Item = std::variant<Box, Capsule, Ring, Stroke, Label>;
using DisplayList = std::vector<Item>;

/// A rectangle of a picture, px.
struct Area {
    float left = 0, top = 0, right = 0, bottom = 0;

    float width() const { return right - left; }
    float height() const { return bottom - top; }
    bool overlaps(const Area& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
    bool contains(const Area& other) const {
        return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
    }
    bool contains(Point p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
    Area grown(float x, float y) const { return {left - x, top - y, right + x, bottom + y}; }
};

}  // namespace doppel

#pragma once

#include "render/display_list.hpp"

namespace doppel {

/// A rectangle of a picture, px.
struct Area {
    float left = 0, top = 0, right = 0, bottom = 0;

    float width() const { return right - left; }
    float height() const { return bottom - top; }
    bool overlaps(const Area& other) const {
        return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
    }
    bool holds(const Area& other) const {
        return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
    }
    bool holds(Point p) const { return p.x >= left && p.x <= right && p.y >= top && p.y <= bottom; }
    Area grown(float x, float y) const { return {left - x, top - y, right + x, bottom + y}; }
};

}  // namespace doppel

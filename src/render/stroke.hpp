#pragma once

#include "render/display_list.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace doppel {

struct Chord {
    Point from, to, axis{1, 0};  // axis: unit vector along the line
    float length;                // px

    Chord(Point start, Point end) : from(start), to(end) {
        const Point along{to.x - from.x, to.y - from.y};
        length = std::sqrt(along.x * along.x + along.y * along.y);
        if (length > 0) axis = {along.x / length, along.y / length};
    }
    Point middle() const { return {(from.x + to.x) / 2, (from.y + to.y) / 2}; }
};

/// The part of the segment from (x0, y0) to (x1, y1) inside the area, as fractions of its length, 0…1. Nothing if the
/// segment is outside (Liang & Barsky 1984).
struct Shares {
    double from = 0, to = 1;
};
std::optional<Shares> clip_segment(const Area& area, double x0, double y0, double x1, double y1);

/// A part of a stroke that one parabola can replace: from vertex `first` to `last`, its middle `bend` px to the right
/// of the chord. Opacity, width and glow vary linearly along the chord.
struct StrokePiece {
    std::size_t first, last;
    float bend = 0;
};

/// The longest piece from vertex `first`, of at most 24 vertices and up to the next joint, that fits the vertices in
/// between. Tolerances: position and edges 1/10 px (1/5 px half way between vertices), glow 1/2 px, opacity 1/255.
/// Widths and glow are in px.
StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first);

/// The simplified curve of a quantity over time: points within 1/5 px of the line through the kept points are left out.
/// Which points are kept depends only on earlier points.
class Trace {
public:
    /// x must increase from point to point.
    void add(Point point);

    /// All kept points and the newest point.
    std::vector<Stroke::Vertex> vertices() const;

private:
    std::vector<Stroke::Vertex> kept_;
    Point newest_{};
    bool pending_ = false;  // the newest point is not a kept point
    // range of slopes from the last kept point that stay within tolerance
    static constexpr float any_slope = std::numeric_limits<float>::max();
    float steepest_ = any_slope, flattest_ = -any_slope;
};

}  // namespace doppel

#pragma once

#include "render/display_list.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace doppel {

/// The straight line between two points.
struct Chord {
    Point from, to, axis{1, 0};  // axis: unit vector along it
    float length;                // px

    Chord(Point start, Point end) : from(start), to(end) {
        const Point along{to.x - from.x, to.y - from.y};
        length = std::sqrt(along.x * along.x + along.y * along.y);
        if (length > 0) axis = {along.x / length, along.y / length};
    }
    Point middle() const { return {(from.x + to.x) / 2, (from.y + to.y) / 2}; }
};

/// The part of the segment from (x0, y0) to (x1, y1) within the area, as shares of its length, 0…1; nothing where it
/// lies outside (Liang & Barsky 1984).
struct Shares {
    double from = 0, to = 1;
};
std::optional<Shares> clip_segment(const Area& area, double x0, double y0, double x1, double y1);

/// A part of a stroke drawn as one primitive: from vertex `first` to `last` along a parabola whose middle lies `bend`
/// px to the right of the chord. Opacity, width and glow vary linearly along the chord.
struct StrokePiece {
    std::size_t first, last;
    float bend = 0;
};

/// Whether pieces may be parabolas, or only straight.
enum class Bends { no, yes };

/// The longest piece from vertex `first`, at most `most` vertices on and no further than a joint, that keeps to all
/// vertices between within tolerances: 1/10 px of position and of either edge (1/5 px of position half way between
/// vertices), 1/2 px of glow, 1/255 of opacity. Widths and glow in px.
StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first, Bends bends, std::size_t most = 24);

/// A curve over time, growing to the right, simplified: points within 1/5 px of the line through the kept ones are left
/// out. What is kept depends only on earlier points.
class Trace {
public:
    /// x must grow from point to point.
    void add(Point point);

    /// All of it, up to the newest point.
    std::vector<Stroke::Vertex> vertices() const;

private:
    std::vector<Stroke::Vertex> kept_;
    Point newest_{};
    bool pending_ = false;               // the newest point is not among the kept
    float steepest_ = 0, flattest_ = 0;  // slopes from the last kept point that miss no point since
};

}  // namespace doppel

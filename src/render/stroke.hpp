#pragma once

#include "render/display_list.hpp"

#include <cmath>
#include <cstddef>

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

/// A part of a stroke that is drawn at once: from vertex `first` to vertex `last` along a parabola that swerves `bend`
/// px to the right of the straight line between them. Opacity, width and glow vary linearly along that line.
struct StrokePiece {
    std::size_t first, last;
    float bend = 0;
};

/// Whether pieces may bend, as those of a smooth path may, or are straight.
enum class Bends { no, yes };

/// The piece from vertex `first` that reaches far, at most `most` vertices on or to a joint, and passes all between
/// within a hair (1/10 px of place and of either edge, 1/5 px of place half way between two vertices, 1/2 px of glow,
/// 1/255 of opacity); widths and glow in px. Simulated paths have many more vertices than bends.
StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first, Bends bends, std::size_t most = 24);

}  // namespace doppel

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

/// What of the straight way from (x0, y0) to (x1, y1) lies within the area, as shares of it, 0…1; nothing where it
/// passes beside (Liang & Barsky 1984).
struct Shares {
    double from = 0, to = 1;
};
std::optional<Shares> clip_segment(const Area& area, double x0, double y0, double x1, double y1);

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

/// The path of a quantity over time, growing to the right, with the points left out that lie within a fifth of a pixel
/// of the straight line through those that stay. What stays depends only on what came before.
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

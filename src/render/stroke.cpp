#include "render/stroke.hpp"

#include <algorithm>

namespace doppel {
namespace {

constexpr float position_tolerance = 1.0f / 10;  // tolerance of positions, px
constexpr float steepest =
    0.25f;  // largest slope of a parabola at its ends; the shader's distance is an approximation for flat ones

/// Coordinates relative to a chord, px: along it from its start, and to its right.
Point local(const Chord& chord, Point at) {
    const Point out{at.x - chord.from.x, at.y - chord.from.y};
    return {chord.axis.x * out.x + chord.axis.y * out.y, chord.axis.x * out.y - chord.axis.y * out.x};
}

float part_of(const Chord& chord, float along) {
    return chord.length > 0 ? std::clamp(along / chord.length, 0.f, 1.f) : 0;
}

/// Height of a parabola of height 1 at a fraction of its chord.
float height(float part) {
    return 4 * part * (1 - part);
}

bool is_close(const Stroke::Vertex& from, const Stroke::Vertex& to, float part, const Stroke::Vertex& v) {
    return std::abs(std::lerp(from.alpha, to.alpha, part) - v.alpha) <= 1.0f / 255 &&
           std::abs(std::lerp(from.width, to.width, part) - v.width) <= 2 * position_tolerance &&
           std::abs(std::lerp(from.glow, to.glow, part) - v.glow) <= 5 * position_tolerance;
}

/// The bend of the piece that passes all vertices between first and last within tolerance, if there is one.
std::optional<float> bend_of(const std::vector<Stroke::Vertex>& path, std::size_t first, std::size_t last) {
    const Stroke::Vertex &from = path[first], &to = path[last];
    const Chord chord(from.at, to.at);
    // the bend given by the vertex in the middle
    const Point middle = local(chord, path[(first + last) / 2].at);
    const float scale = height(part_of(chord, middle.x));
    const float bend = scale > 0.3f ? middle.y / scale : 0;
    if (!(std::abs(bend) <= steepest / 4 * chord.length)) return {};

    Point before;
    for (std::size_t i = first + 1; i <= last; ++i) {
        const Stroke::Vertex& v = path[i];
        const Point at = local(chord, v.at), between{(before.x + at.x) / 2, (before.y + at.y) / 2};
        const float part = part_of(chord, at.x);
        const auto aside = [&](Point p) { return std::abs(p.y - bend * height(part_of(chord, p.x))); };
        if (!(at.x >= before.x - position_tolerance && at.x <= chord.length + position_tolerance &&
              aside(at) <= position_tolerance && aside(between) <= 2 * position_tolerance))
            return {};
        if (i < last && (v.joint || v.bend != 0 || !is_close(from, to, part, v))) return {};
        before = at;
    }
    return bend;
}

constexpr float tolerance = 0.2f;  // of a trace, px

/// A joint, so that later points change nothing before it.
Stroke::Vertex vertex(Point at) {
    return {.at = at, .joint = true};
}

}  // namespace

std::optional<Shares> clip_segment(const Area& area, double x0, double y0, double x1, double y1) {
    Shares within;
    const double dx = x1 - x0, dy = y1 - y0;
    // keeps the shares for which share · step ≤ room
    const auto cut = [&](double step, double room) {
        if (step < 0) within.from = std::max(within.from, room / step);
        if (step > 0) within.to = std::min(within.to, room / step);
        return step != 0 || room >= 0;
    };
    const bool meets = cut(-dx, x0 - area.left) && cut(dx, area.right - x0) && cut(-dy, y0 - area.top) &&
                       cut(dy, area.bottom - y0) && within.from <= within.to;
    return meets ? std::optional(within) : std::nullopt;
}

StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first) {
    constexpr std::size_t maximum = 24;
    StrokePiece piece{first, first + 1, path[first].bend};
    const std::size_t end = std::min(path.size() - 1, first + maximum);
    if (path[first].bend != 0 || path[piece.last].joint) return piece;
    while (piece.last < end) {
        const auto bend = bend_of(path, first, piece.last + 1);
        if (!bend) break;
        piece = {first, piece.last + 1, *bend};
    }
    return piece;
}

void Trace::add(Point point) {
    if (kept_.empty()) return kept_.push_back(vertex(point));
    const auto slope = [&](float dy) {
        const Point from = kept_.back().at;
        return (point.y + dy - from.y) / std::max(point.x - from.x, 1e-6f);
    };
    if (pending_ && (slope(0) > steepest_ || slope(0) < flattest_)) {
        kept_.push_back(vertex(newest_));
        steepest_ = any_slope;
        flattest_ = -any_slope;
    }
    steepest_ = std::min(steepest_, slope(tolerance));
    flattest_ = std::max(flattest_, slope(-tolerance));
    newest_ = point;
    pending_ = true;
}

std::vector<Stroke::Vertex> Trace::vertices() const {
    auto all = kept_;
    if (pending_) all.push_back(vertex(newest_));
    return all;
}

}  // namespace doppel

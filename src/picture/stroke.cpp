#include "picture/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

constexpr float hair = 1.0f / 10;  // px
// of a parabola, at its ends: what lies beside a flat one is nearest to what it lies beside
constexpr float steepest = 0.25f;

/// The straight line between two vertices, and places in its own axes: how far along and how far beside, px.
struct Chord {
    Point from, axis{1, 0};
    float length;

    Chord(Point start, Point end) : from(start) {
        const Point along{end.x - start.x, end.y - start.y};
        length = std::sqrt(along.x * along.x + along.y * along.y);
        if (length > 0) axis = {along.x / length, along.y / length};
    }
    Point local(Point at) const {
        const Point out{at.x - from.x, at.y - from.y};
        return {axis.x * out.x + axis.y * out.y, axis.x * out.y - axis.y * out.x};
    }
    float share(float along) const { return length > 0 ? std::clamp(along / length, 0.f, 1.f) : 0; }
};

/// A parabola's height at a share of the way, where it is 1 in the middle.
float height(float share) {
    return 4 * share * (1 - share);
}

bool is_like(const Stroke::Vertex& from, const Stroke::Vertex& to, float share, const Stroke::Vertex& v) {
    return std::abs(std::lerp(from.alpha, to.alpha, share) - v.alpha) <= 1.0f / 255 &&
           std::abs(std::lerp(from.width, to.width, share) - v.width) <= 2 * hair &&
           std::abs(std::lerp(from.glow, to.glow, share) - v.glow) <= 5 * hair;
}

/// The bend of the piece that passes all vertices between first and last, if there is one.
std::optional<float> bend_of(const std::vector<Stroke::Vertex>& path, std::size_t first, std::size_t last,
                             Bends bends) {
    const Stroke::Vertex &from = path[first], &to = path[last];
    const Chord chord(from.at, to.at);
    // as high as one in the middle wants it
    const Point middle = chord.local(path[(first + last) / 2].at);
    const float scale = height(chord.share(middle.x));
    const float bend = bends == Bends::yes && scale > 0.3f ? middle.y / scale : 0;
    if (!(std::abs(bend) <= steepest / 4 * chord.length)) return {};

    Point before;
    for (std::size_t i = first + 1; i <= last; ++i) {
        const Stroke::Vertex& v = path[i];
        const Point at = chord.local(v.at), between{(before.x + at.x) / 2, (before.y + at.y) / 2};
        const float share = chord.share(at.x);
        const auto aside = [&](Point p) { return std::abs(p.y - bend * height(chord.share(p.x))); };
        if (!(at.x >= before.x - hair && at.x <= chord.length + hair && aside(at) <= hair && aside(between) <= 2 * hair))
            return {};
        if (i < last && (v.joint || v.bend != 0 || !is_like(from, to, share, v))) return {};
        before = at;
    }
    return bend;
}

}  // namespace

StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first, Bends bends, std::size_t most) {
    StrokePiece piece{first, first + 1, path[first].bend};
    const std::size_t end = std::min(path.size() - 1, first + most);
    if (path[first].bend != 0 || path[piece.last].joint) return piece;
    while (piece.last < end) {
        const auto bend = bend_of(path, first, piece.last + 1, bends);
        if (!bend) break;
        piece = {first, piece.last + 1, *bend};
    }
    return piece;
}

}  // namespace doppel

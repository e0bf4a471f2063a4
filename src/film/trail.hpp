#pragma once

#include "film/layout.hpp"
#include "scene/scene.hpp"

#include <deque>
#include <limits>
#include <optional>

namespace doppel {

/// The cubic from p to q with the slopes v and w (Hermite), at the share s of the way, which takes dt.
inline double hermite(double p, double v, double q, double w, double dt, double s) {
    const double r = 1 - s;
    return (1 + 2 * s) * r * r * p + s * r * r * dt * v + s * s * (3 - 2 * s) * q - s * s * r * dt * w;
}

/// A path that fades and tapers with its age.
class Trail {
public:
    /// `width` in px.
    Trail(const Scene& scene, const Style& style, Color color, float width);
    Trail(const Scene& scene, const Style& style, std::size_t side)
        : Trail(scene, style, style.theme.sides[side], px(style.width.trail)) {}

    std::optional<Point> end() const;
    /// The path goes on to a place, where it was at `time`, s. What has faded by `now` goes.
    void add(Point at, double time, double now);

    /// Up to the head, where there is one; broken where it leaves the area, or where a point is NaN, and between
    /// points more than `jump` px apart across.
    void draw(const Area& area, double now, std::optional<Point> head, DisplayList& list,
              float jump = std::numeric_limits<float>::infinity()) const;

private:
    struct TrailPoint {
        Point at;
        double time;         // s
        long group;          // of points that fade together
        float bend = 0;      // px, of the way to the next one
        bool joint = false;  // this one stays
    };
    using Points = std::deque<TrailPoint>;

    void simplify(Points& points) const;
    double end_of(long group) const;
    double faded_until(long group, double now) const;
    void draw_piece(Points points, const Area& area, double now, DisplayList& list) const;

    double sample_hz_, trail_s_;
    Stroke pen_;  // without a path
    Points points_;
};

}  // namespace doppel

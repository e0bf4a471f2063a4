#include "film/composer.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

// What fades would have to be drawn anew at every sample. Instead the points of a trail fade in groups, each group at
// every fourth sample only and in turn: a step is 2 % of the light at most, at 30 Hz, and no two groups take it at
// once.
constexpr long group = 24, tick = 4;  // samples

/// The sample for which the fading of group `g` was last brought up to date.
long last_tick(long sample, long g) {
    return (sample + g) / tick * tick - g;
}

}  // namespace

/// Adds the way from the last bob to this one: a cubic through both with their velocities (Hermite), in pieces of a few
/// pixels.
void Composer::extend_trail(std::size_t side, const Bob<double>& bob, double time) {
    const auto& panel = panel_of(side);
    auto& trail = trails_[side];
    const float piece = std::max(8 * layout_.unit, 2.0f), least = std::max(1.5f * layout_.unit, 0.5f);  // px
    const auto apart = [](Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); };

    const auto extend = [&](Point at, double when) {
        if (trail.empty() || apart(at, trail.back().at) >= least) trail.push_back({at, when});
    };
    if (auto& last = last_bob_[side]) {
        const auto& [from, from_time] = *last;
        const double dt = time - from_time;
        const float length = apart(panel.at(from.x, from.y), panel.at(bob.x, bob.y));
        const int pieces = std::clamp(static_cast<int>(std::ceil(length / piece)), 1, 32);
        for (int i = 1; i <= pieces; ++i) {
            const double s = static_cast<double>(i) / pieces, r = 1 - s;
            const auto cubic = [&](double p, double v, double q, double w) {
                return (1 + 2 * s) * r * r * p + s * r * r * dt * v + s * s * (3 - 2 * s) * q - s * s * r * dt * w;
            };
            extend(panel.at(cubic(from.x, from.vx, bob.x, bob.vx), cubic(from.y, from.vy, bob.y, bob.vy)),
                   from_time + s * dt);
        }
    } else {
        extend(panel.at(bob.x, bob.y), time);
    }
    last_bob_[side] = {bob, time};
    drop_faded(trail);
}

/// Whole groups: the quads of those that stay keep their places, and need no drawing.
void Composer::drop_faded(Trail& trail) const {
    const double oldest = now() - scene_.preset.video.trail_s;
    const auto faded = [&](const TrailPoint& point) {
        return static_cast<double>((group_of(point.time) + 1) * group) / scene_.preset.sample_hz.value() < oldest;
    };
    while (!trail.empty() && faded(trail.front())) trail.pop_front();
}

long Composer::group_of(double time) const {
    return static_cast<long>(std::floor(time * scene_.preset.sample_hz.value() + 1e-6)) / group;
}

/// A path that fades and tapers with its age; broken where it leaves the area, or where a point is no number.
void Composer::compose_trail(std::size_t side, const Area& area, std::optional<Point> head, const Trail& trail,
                             DisplayList& list) const {
    const double time = now(), trail_s = scene_.preset.video.trail_s;
    if (!(trail_s > 0)) return;
    const Stroke pen{.vertices = {},
                     .width = static_cast<float>(layout_.style.width.trail),
                     .color = layout_.style.theme.sides[side],
                     .glow = layout_.style.glow};
    Stroke stroke = pen;
    const auto extend = [&](Point at, double when) {
        if (!area.holds(at)) {
            if (!stroke.vertices.empty()) list.push_back(std::move(stroke));
            stroke = pen;
            return;
        }
        const double seen_at = scene_.time(last_tick(now_.moment.sample, group_of(when)));
        const double freshness = std::clamp(1 - (seen_at - when) / trail_s, 0.0, 1.0);
        constexpr double thinnest = 0.55;
        stroke.vertices.push_back({at, static_cast<float>(std::pow(freshness, 1.6)),
                                   static_cast<float>(thinnest + (1 - thinnest) * freshness),
                                   static_cast<float>(freshness * freshness)});
    };
    for (const auto& point : trail) extend(point.at, point.time);
    if (head) extend(*head, time);
    if (!stroke.vertices.empty()) list.push_back(std::move(stroke));
}

}  // namespace doppel

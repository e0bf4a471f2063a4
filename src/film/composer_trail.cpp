#include "film/composer.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

// What fades would have to be drawn anew at every sample. Instead the points of a trail fade in groups, each by steps
// of 3 % of the light, and hardly ever two at once.
constexpr long group = 24;      // samples
constexpr double steps = 32;    // from full light to none
constexpr double fading = 1.6;  // the light is this power of the freshness

}  // namespace

/// Adds the way from the last bob to this one: a cubic through both with their velocities (Hermite), in pieces of a few
/// pixels.
void Composer::extend_trail(std::size_t side, const Bob<double>& bob, double time) {
    const auto& panel = panel_of(side);
    auto& trail = trails_[side];
    const float piece = std::max(8 * layout_.unit, 2.0f), least = std::max(1.5f * layout_.unit, 0.5f);  // px
    const auto apart = [](Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); };

    const auto go_on = [&](Point at, double when) {
        if (trail.empty() || apart(at, trail.back().at) >= least) extend(trail, at, when);
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
            go_on(panel.at(cubic(from.x, from.vx, bob.x, bob.vx), cubic(from.y, from.vy, bob.y, bob.vy)),
                  from_time + s * dt);
        }
    } else {
        go_on(panel.at(bob.x, bob.y), time);
    }
    last_bob_[side] = {bob, time};
}

/// Adds a point; whole groups go when they have faded.
void Composer::extend(Trail& trail, Point at, double time) const {
    const long g = static_cast<long>(std::floor(time * scene_.preset.sample_hz.value() + 1e-6)) / group;
    if (!trail.empty() && trail.back().group != g) {
        settle(trail);
        // the new group goes on from where the last one ends
        TrailPoint first = trail.back();
        first.group = g;
        trail.push_back(first);
    }
    trail.push_back({at, time, g});
    while (end_of(trail.front().group) < now() - scene_.preset.video.trail_s) trail.pop_front();
}

/// Keeps of the newest group only the points between which it bends evenly.
void Composer::settle(Trail& trail) const {
    std::size_t begin = trail.size() - 1;
    while (begin > 0 && trail[begin - 1].group == trail.back().group) --begin;
    std::vector<Stroke::Vertex> path;
    for (std::size_t i = begin; i < trail.size(); ++i) {
        // light falls with time: evenly, in short
        const double part = (trail[i].time - trail[begin].time) / scene_.preset.video.trail_s;
        path.push_back(
            {.at = trail[i].at, .alpha = static_cast<float>(part), .bend = trail[i].bend, .joint = trail[i].joint});
    }
    std::size_t kept = begin;
    for (std::size_t i = 0; i < path.size(); ++kept) {
        const auto piece = i + 1 < path.size() ? next_piece(path, i, Bends::yes) : StrokePiece{i, i + 1};
        trail[kept] = trail[begin + i];
        trail[kept].bend = piece.bend;
        trail[kept].joint = true;
        i = piece.last;
    }
    trail.resize(kept);
}

/// When the last sample of a group is over, s.
double Composer::end_of(long g) const {
    return static_cast<double>((g + 1) * group) / scene_.preset.sample_hz.value();
}

/// For what time a group's points look their age: not yet that of the next step.
double Composer::faded_until(long g) const {
    const double end = end_of(g), trail_s = scene_.preset.video.trail_s;
    const double light = std::pow(std::max(1 - (now() - end) / trail_s, 0.0), fading);
    return end + (1 - std::pow(std::ceil(steps * light) / steps, 1 / fading)) * trail_s;
}

/// A path that fades and tapers with its age, up to the head; broken where it leaves the area, or where a point is no
/// number.
void Composer::compose_trail(std::size_t side, const Area& area, std::optional<Point> head, Trail trail,
                             DisplayList& list) const {
    const double trail_s = scene_.preset.video.trail_s;
    if (!(trail_s > 0) || trail.empty()) return;
    if (head) trail.push_back({*head, now(), trail.back().group});
    settle(trail);
    const Stroke pen{.vertices = {},
                     .width = static_cast<float>(layout_.style.width.trail),
                     .color = layout_.style.theme.sides[side],
                     .glow = layout_.style.glow};
    Stroke stroke = pen;
    std::optional<long> last_group;
    double until = 0;
    const auto add = [&](const TrailPoint& point) {
        if (!area.holds(point.at)) {
            if (!stroke.vertices.empty()) list.push_back(std::move(stroke));
            stroke = pen;
            return;
        }
        if (point.group != last_group) until = faded_until(point.group);
        last_group = point.group;
        const double freshness = std::clamp(1 - (until - point.time) / trail_s, 0.0, 1.0);
        constexpr double thinnest = 0.55;
        stroke.vertices.push_back({.at = point.at,
                                   .alpha = static_cast<float>(std::pow(freshness, fading)),
                                   .width = static_cast<float>(thinnest + (1 - thinnest) * freshness),
                                   .glow = static_cast<float>(std::pow(freshness, 4)),
                                   .bend = point.bend,
                                   .joint = point.joint});
    };
    for (const auto& point : trail) add(point);
    if (!stroke.vertices.empty()) list.push_back(std::move(stroke));
}

}  // namespace doppel

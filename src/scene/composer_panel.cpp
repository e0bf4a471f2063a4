#include "scene/composer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace doppel {
namespace {

/// The part of from…to that is in the area, if any (Liang & Barsky 1984).
std::optional<std::pair<Point, Point>> clipped(Point from, Point to, const Area& area) {
    const Point along{to.x - from.x, to.y - from.y};
    float first = 0, last = 1;                       // shares of the way
    const auto keep = [&](float step, float room) {  // the side of a border where share · step ≤ room
        if (step < 0) first = std::max(first, room / step);
        if (step > 0) last = std::min(last, room / step);
        return step != 0 || room >= 0;
    };
    const bool beside = keep(-along.x, from.x - area.left) && keep(along.x, area.right - from.x) &&
                        keep(-along.y, from.y - area.top) && keep(along.y, area.bottom - from.y);
    if (!beside || first > last) return std::nullopt;
    const auto at = [&](float share) { return Point{from.x + share * along.x, from.y + share * along.y}; };
    return std::pair{first > 0 ? at(first) : from, last < 1 ? at(last) : to};
}

float apart(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

/// Adds the way from the last bob to this one: a cubic through both with their velocities (Hermite), in pieces of a few
/// pixels.
void Composer::extend_trail(std::size_t side, const Bob<double>& bob, double time) {
    const auto& panel = (*layout_.panels)[side];
    auto& trail = trails_[side];
    const float piece = std::max(8 * layout_.unit, 2.0f), least = std::max(1.5f * layout_.unit, 0.5f);  // px

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
    while (!trail.empty() && trail.front().time < time - scene_.preset.video.trail_s) trail.pop_front();
}

void Composer::compose_panel(std::size_t side, DisplayList& list) const {
    const auto& panel = (*layout_.panels)[side];
    const auto& own = side == 0 ? now_.a : now_.b;
    const auto& other = side == 0 ? now_.b : now_.a;

    // where the twin is now, faintly and behind all else; as long as they swing as one this side hides it
    const Color ghost = mixed(theme_.panel, theme_.sides[1 - side], 0.26f);
    compose_lines(1 - side, panel, other.bobs, 0.7f * layout_.rod_radius, ghost, list);
    for (const auto& bob : other.bobs) compose_disc(panel, panel.at(bob.x, bob.y), bob_radius(bob), ghost, list);

    if (scene_.preset.video.trail_s > 0) compose_trail(side, panel.at(own.bobs.back().x, own.bobs.back().y), list);

    // this side: rods, then the pivot and the bobs, each on a rim that sets it off
    compose_lines(side, panel, own.bobs, layout_.rod_radius, theme_.rod, list);
    compose_pivots(side, list);
    for (const auto& bob : own.bobs) {
        const Point at = panel.at(bob.x, bob.y);
        const bool last = &bob == &own.bobs.back();
        const float radius = last ? std::max(bob_radius(bob), layout_.last_bob_radius) : bob_radius(bob);
        const float rim = std::min(std::max(2 * layout_.unit, 0.75f), 0.3f * radius);
        compose_disc(panel, at, radius + rim, theme_.panel, list);
        compose_disc(panel, at, radius, last ? theme_.sides[side] : theme_.bob, list);
    }
}

const std::vector<MechanismLine>& Composer::lines(std::size_t side) const {
    return (side == 0 ? scene_.a : scene_.b).lines;
}

/// Rods, and springs as thin zigzags.
void Composer::compose_lines(std::size_t side, const PanelLayout& panel, const Bobs<double>& bobs, float radius,
                             Color color, DisplayList& list) const {
    const auto at = [&](const End<double>& end) {
        if (const auto* bob = std::get_if<std::size_t>(&end)) return panel.at(bobs[*bob].x, bobs[*bob].y);
        const auto& place = std::get<Place<double>>(end);
        return panel.at(place[0], place[1]);
    };
    const auto draw = [&](Point from, Point to, float width) {
        if (const auto seen = clipped(from, to, panel.area))
            list.push_back(Capsule{seen->first, seen->second, width, color});
    };
    for (const auto& line : lines(side)) {
        if (line.kind == MechanismLine::Kind::rod) draw(at(line.from), at(line.to), radius);
        if (line.kind != MechanismLine::Kind::spring) continue;
        constexpr int turns = 16;
        const Point from = at(line.from), to = at(line.to), along{to.x - from.x, to.y - from.y};
        const float length = std::max(apart(from, to), 1.0f), swing = 0.5f * layout_.bob_radius / length;
        Point last = from;
        for (int i = 1; i <= turns; ++i) {
            const float share = (static_cast<float>(i) - 0.5f) / turns, side_way = i % 2 == 0 ? swing : -swing;
            const Point next{from.x + share * along.x - side_way * along.y,
                             from.y + share * along.y + side_way * along.x};
            draw(last, next, 0.45f * radius);
            last = next;
        }
        draw(last, to, 0.45f * radius);
    }
}

/// Slots that bobs slide in.
void Composer::compose_tracks(std::size_t side, DisplayList& list) const {
    const auto& panel = (*layout_.panels)[side];
    const float width = std::max(1.5f * layout_.unit, 1.0f);
    for (const auto& line : lines(side)) {
        const auto* from = std::get_if<Place<double>>(&line.from);
        if (!from) continue;
        const Point at = panel.at((*from)[0], (*from)[1]);
        if (line.kind == MechanismLine::Kind::slot_circle)
            list.push_back(Ring{at, panel.px_per_m * static_cast<float>(line.radius), width, theme_.grid});
        const auto* to = std::get_if<Place<double>>(&line.to);
        if (line.kind != MechanismLine::Kind::slot_line || !to) continue;
        // on beyond both ends, to the edges of the panel
        const Point end = panel.at((*to)[0], (*to)[1]), along{end.x - at.x, end.y - at.y};
        const float far = (panel.area.width() + panel.area.height()) / std::max(apart(at, end), 1e-3f);
        if (const auto seen = clipped({at.x - far * along.x, at.y - far * along.y},
                                      {at.x + far * along.x, at.y + far * along.y}, panel.area))
            list.push_back(Capsule{seen->first, seen->second, width / 2, theme_.grid});
    }
}

/// Where the fixed ends are.
void Composer::compose_pivots(std::size_t side, DisplayList& list) const {
    const auto& panel = (*layout_.panels)[side];
    for (const auto& line : lines(side)) {
        using Kind = MechanismLine::Kind;
        if (line.kind == Kind::slot_line || line.kind == Kind::slot_circle) continue;
        const bool one_end = line.kind == Kind::anchor;
        for (const auto* end : {&line.from, one_end ? nullptr : &line.to})
            if (const auto* place = end ? std::get_if<Place<double>>(end) : nullptr)
                compose_disc(panel, panel.at((*place)[0], (*place)[1]),
                             std::max(0.4f * layout_.bob_radius, 0.5f * layout_.last_bob_radius), theme_.pivot, list);
    }
}

/// A disc that is at home in the panel; one that a blow-up threw out of it is not shown.
void Composer::compose_disc(const PanelLayout& panel, Point at, float radius, Color color, DisplayList& list) const {
    if (panel.area.holds(at)) list.push_back(Capsule{at, at, radius, color});
}

/// The path of the last bob, fading with its age; broken where it leaves the panel.
void Composer::compose_trail(std::size_t side, Point head, DisplayList& list) const {
    const Area& area = (*layout_.panels)[side].area;
    const double time = scene_.time(now_.sample), trail_s = scene_.preset.video.trail_s;
    Stroke stroke{{}, std::max(3.4f * layout_.unit, 1.2f), theme_.sides[side]};
    const auto extend = [&](Point at, double when) {
        if (!area.holds(at)) {
            if (!stroke.vertices.empty()) list.push_back(stroke);
            stroke.vertices.clear();
            return;
        }
        const double freshness = std::clamp(1 - (time - when) / trail_s, 0.0, 1.0);
        stroke.vertices.push_back({at, static_cast<float>(std::pow(freshness, 1.6))});
    };
    for (const auto& point : trails_[side]) extend(point.at, point.time);
    extend(head, time);
    if (!stroke.vertices.empty()) list.push_back(std::move(stroke));
}

/// Area by mass, but never too small to see; px.
float Composer::bob_radius(const Bob<double>& bob) const {
    const auto share = static_cast<float>(std::sqrt(bob.mass / heaviest_));
    return std::max(layout_.bob_radius * share, 1.6f * layout_.rod_radius);
}

}  // namespace doppel

#include "film/composer.hpp"
#include "render/font.hpp"
#include "render/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace doppel {
namespace {

/// The part of from…to that is in the area, if any.
std::optional<std::pair<Point, Point>> clipped(Point from, Point to, const Area& area) {
    const auto within = shares_within(area, from.x, from.y, to.x, to.y);
    if (!within) return std::nullopt;
    const auto at = [&](double share) {
        return Point{static_cast<float>(std::lerp(from.x, to.x, share)),
                     static_cast<float>(std::lerp(from.y, to.y, share))};
    };
    return std::pair{at(within->from), at(within->to)};
}

float apart(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// A disc that is at home in the panel; one that a blow-up threw out of it is not shown.
void add_disc(const PendulumPanel& panel, Point at, float radius, Color color, DisplayList& list, float glow = 0) {
    if (panel.area.holds(at))
        list.push_back(Capsule{.from = at, .to = at, .radius = radius, .color = color, .glow = glow});
}

}  // namespace

void Composer::compose_panel_backdrop(const PendulumPanel& panel, DisplayList& list) const {
    const float t = layout_.text, u = layout_.unit;
    const auto& style = layout_.style;
    const auto& area = panel.area;
    if (!scene_.preset.video.transparent)
        list.push_back(Box{area.left, area.top, area.right, area.bottom, 14 * u, style.theme.panel});
    if (layout_.reach > 0)
        list.push_back(Ring{panel.center, layout_.reach, static_cast<float>(style.width.grid), style.theme.grid});
    for (const auto side : panel.sides) compose_tracks(side, panel, list);

    const float share = panel.words.size() > 1 ? 0.48f : 1;  // of the width, where there are words in both corners
    const float width = share * (area.width() - 56 * u);
    for (const auto& words : panel.words) {
        const float x = words.align == Align::right ? area.right - 28 * u : area.left + 28 * u;
        const auto add = [&](const std::string& text, float y, double px, Weight weight, Color color) {
            const float size = fitting_size(text, static_cast<float>(px), weight, width);
            list.push_back(Label{text, {x, area.top + y}, size, words.align, weight, color});
        };
        const auto color =
            scene_.crowd.empty() ? style.theme.sides[words.side] : member_color(style, static_cast<double>(words.side));
        add(words.heading, 50 * t, style.font.heading, Weight::bold, color);
        add(words.note, 82 * t, style.font.note, Weight::regular, style.theme.quiet_text);
    }
}

void Composer::compose_panel(const PendulumPanel& panel, DisplayList& list) const {
    const auto& theme = layout_.style.theme;
    if (!now_.crowd.empty()) {
        compose_crowd(panel, list);
        return;
    }
    const bool alone = panel.sides.size() == 1;
    if (alone) {
        // where the twin is now, faintly and behind all else; as long as they swing as one this side hides it
        const std::size_t other = 1 - panel.sides.front();
        if (!swing_as_one(panel)) {
            const Color ghost = mixed(theme.panel, theme.sides[other], 0.26f);
            compose_lines(other, panel, seen(other).bobs, 0.7f * layout_.rod_radius, ghost, list);
            for (const auto& bob : seen(other).bobs)
                add_disc(panel, panel.at(bob.x, bob.y), bob_radius(bob), ghost, list);
        }
    }
    for (auto side = panel.sides.rbegin(); side != panel.sides.rend(); ++side) {
        const auto& bob = seen(*side).bobs.back();
        compose_trail(*side, panel.area, panel.at(bob.x, bob.y), trails_[*side], list);
    }
    for (auto side = panel.sides.rbegin(); side != panel.sides.rend(); ++side)
        compose_pendulum(panel, *side, alone, list);
}

/// Whether the two cannot be told apart in this panel.
bool Composer::swing_as_one(const PendulumPanel& panel) const {
    const auto same_bob = [&](const Bob<double>& a, const Bob<double>& b) {
        return a.mass == b.mass && apart(panel.at(a.x, a.y), panel.at(b.x, b.y)) < 0.1f;  // px
    };
    const auto same_line = [](const MechanismLine& a, const MechanismLine& b) {
        return a.kind == b.kind && a.from == b.from && a.to == b.to;
    };
    return std::ranges::equal(seen(0).bobs, seen(1).bobs, same_bob) &&
           std::ranges::equal(lines(0), lines(1), same_line);
}

/// Rods, then the pivot and the bobs, each on a rim that sets it off. Where two share a panel all of each has its hue.
void Composer::compose_pendulum(const PendulumPanel& panel, std::size_t side, bool alone, DisplayList& list) const {
    const auto& theme = layout_.style.theme;
    const auto hued = [&](Color color, float share) { return alone ? color : mixed(color, theme.sides[side], share); };
    compose_lines(side, panel, seen(side).bobs, layout_.rod_radius, hued(theme.rod, 0.55f), list);
    compose_pivots(side, panel, list);
    for (const auto& bob : seen(side).bobs) {
        const Point at = panel.at(bob.x, bob.y);
        const bool last = &bob == &seen(side).bobs.back();
        const float radius = last ? std::max(bob_radius(bob), layout_.last_bob_radius) : bob_radius(bob);
        const float rim = std::min(std::max(2 * layout_.unit, 0.75f), 0.3f * radius);
        if (!scene_.preset.video.transparent) add_disc(panel, at, radius + rim, theme.panel, list);
        add_disc(panel, at, radius, last ? theme.sides[side] : hued(theme.bob, 0.4f), list,
                 last ? layout_.style.glow : 0);
    }
}

/// The members of an ensemble, the last one behind: fine rods that let each other shine through, and the last bobs.
void Composer::compose_crowd(const PendulumPanel& panel, DisplayList& list) const {
    const auto& style = layout_.style;
    const auto count = now_.crowd.size();
    const auto color_of = [&](std::size_t k) {
        return member_color(style, static_cast<double>(k) / static_cast<double>(std::max<std::size_t>(count - 1, 1)));
    };
    const float rod =
        style.width.rod > 0 ? layout_.rod_radius : std::max(0.5f * layout_.rod_radius, 0.6f * layout_.unit);
    // the more there are, the more they let through
    const float alpha = std::clamp(6 / std::sqrt(static_cast<float>(count)), 0.16f, 0.9f);
    for (std::size_t k = count; k-- > 0;)
        compose_lines(0, panel, now_.crowd[k], rod, color_of(k).with_alpha(alpha), list);
    compose_pivots(0, panel, list);
    for (std::size_t k = count; k-- > 0;) {
        const auto& bob = now_.crowd[k].back();
        add_disc(panel, panel.at(bob.x, bob.y), 0.45f * bob_radius(bob), color_of(k), list);
    }
}

const std::vector<MechanismLine>& Composer::lines(std::size_t side) const {
    return (side == 0 ? scene_.a : scene_.b).lines;
}

/// Rods, and springs as thin zigzags.
void Composer::compose_lines(std::size_t side, const PendulumPanel& panel, const Bobs<double>& bobs, float radius,
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
void Composer::compose_tracks(std::size_t side, const PendulumPanel& panel, DisplayList& list) const {
    const auto width = static_cast<float>(layout_.style.width.grid);
    const auto& color = layout_.style.theme.grid;
    for (const auto& line : lines(side)) {
        const auto* from = std::get_if<Place<double>>(&line.from);
        if (!from) continue;
        const Point at = panel.at((*from)[0], (*from)[1]);
        if (line.kind == MechanismLine::Kind::slot_circle)
            list.push_back(Ring{at, panel.px_per_m * static_cast<float>(line.radius), width, color});
        const auto* to = std::get_if<Place<double>>(&line.to);
        if (line.kind != MechanismLine::Kind::slot_line || !to) continue;
        // on beyond both ends, to the edges of the panel
        const Point end = panel.at((*to)[0], (*to)[1]), along{end.x - at.x, end.y - at.y};
        const float far = (panel.area.width() + panel.area.height()) / std::max(apart(at, end), 1e-3f);
        if (const auto seen = clipped({at.x - far * along.x, at.y - far * along.y},
                                      {at.x + far * along.x, at.y + far * along.y}, panel.area))
            list.push_back(Capsule{seen->first, seen->second, width / 2, color});
    }
}

/// Where the fixed ends are.
void Composer::compose_pivots(std::size_t side, const PendulumPanel& panel, DisplayList& list) const {
    for (const auto& line : lines(side)) {
        using Kind = MechanismLine::Kind;
        if (line.kind == Kind::slot_line || line.kind == Kind::slot_circle) continue;
        const bool one_end = line.kind == Kind::anchor;
        for (const auto* end : {&line.from, one_end ? nullptr : &line.to})
            if (const auto* place = end ? std::get_if<Place<double>>(end) : nullptr)
                add_disc(panel, panel.at((*place)[0], (*place)[1]),
                         std::max(0.4f * layout_.bob_radius, 0.5f * layout_.last_bob_radius), layout_.style.theme.pivot,
                         list);
    }
}

/// Area by mass, but never too small to see; px.
float Composer::bob_radius(const Bob<double>& bob) const {
    const auto share = static_cast<float>(std::sqrt(bob.mass / heaviest_));
    return std::max(layout_.bob_radius * share, 1.6f * layout_.rod_radius);
}

}  // namespace doppel

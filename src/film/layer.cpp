#include "film/layer.hpp"

#include "numeric/state.hpp"
#include "render/stroke.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

/// Cubic Hermite interpolation from p to q with slopes v and w, at the fraction s of the interval dt.
double hermite(double p, double v, double q, double w, double dt, double s) {
    const double r = 1 - s;
    return (1 + 2 * s) * r * r * p + s * r * r * dt * v + s * s * (3 - 2 * s) * q - s * s * r * dt * w;
}

// Fading points have to be redrawn. To limit this, the points of a trail fade in groups, in steps of 3 % of the light,
// and rarely two groups at once.
constexpr long group = 24;      // samples
constexpr double steps = 32;    // from full light to none
constexpr double fading = 1.6;  // brightness = freshness to this power

}  // namespace

Trail::Trail(const Scene& scene, const Style& style, Color color, float width, float jump)
    : sample_hz_(scene.preset.sample_hz.value()),
      trail_s_(scene.preset.video.trail_s),
      jump_(jump),
      pen_{.vertices = {}, .width = width, .color = color, .glow = style.glow} {}

std::optional<Point> Trail::end() const {
    return points_.empty() ? std::nullopt : std::optional(points_.back().vertex.at);
}

void Trail::add(Point at, double time, double now) {
    const long g = static_cast<long>(std::floor(time * sample_hz_ + 1e-6)) / group;
    if (!points_.empty() && points_.back().group != g) {
        simplify(points_);
        // the new group begins where the last one ends
        TrailPoint first = points_.back();
        first.group = g;
        first.starts = false;
        points_.push_back(first);
    }
    const bool starts = !points_.empty() && std::abs(at.x - points_.back().vertex.at.x) > jump_;
    if (starts) points_.back().vertex.joint = true;
    points_.push_back({{.at = at, .joint = starts}, time, g, starts});
    while (end_of(points_.front().group) < now - trail_s_) points_.pop_front();
}

/// Removes points of the newest group between which the path bends evenly.
void Trail::simplify(Points& points) const {
    std::size_t begin = points.size() - 1;
    while (begin > 0 && points[begin - 1].group == points.back().group) --begin;
    std::vector<Stroke::Vertex> path;
    for (std::size_t i = begin; i < points.size(); ++i) {
        // brightness falls almost linearly over short times
        path.push_back(points[i].vertex);
        path.back().alpha = static_cast<float>((points[i].time - points[begin].time) / trail_s_);
    }
    std::size_t kept = begin;
    for (std::size_t i = 0; i < path.size(); ++kept) {
        const auto piece = i + 1 < path.size() ? next_piece(path, i) : StrokePiece{i, i + 1};
        points[kept] = points[begin + i];
        points[kept].vertex.bend = piece.bend;
        points[kept].vertex.joint = true;
        i = piece.last;
    }
    points.resize(kept);
}

/// The time of a group's last sample, s.
double Trail::end_of(long g) const {
    return static_cast<double>((g + 1) * group) / sample_hz_;
}

/// The time for which the points of a group show their age; it advances in steps.
double Trail::faded_until(long g, double now) const {
    const double end = end_of(g);
    const double light = std::pow(std::max(1 - (now - end) / trail_s_, 0.0), fading);
    return end + (1 - std::pow(std::ceil(steps * light) / steps, 1 / fading)) * trail_s_;
}

void Trail::draw(const Area& area, double now, std::optional<Point> head, DisplayList& list, Point shift) const {
    if (!(trail_s_ > 0) || !(pen_.width > 0) || points_.empty()) return;
    auto points = points_;
    if (head) points.push_back({{.at = *head}, now, points.back().group});
    simplify(points);
    Stroke stroke = pen_;
    const auto end_stroke = [&] {
        if (!stroke.vertices.empty()) list.push_back(std::exchange(stroke, pen_));
    };
    std::optional<long> last_group;
    double until = 0;
    for (const auto& point : points) {
        auto vertex = point.vertex;
        vertex.at = {vertex.at.x + shift.x, vertex.at.y + shift.y};
        const bool is_within = area.contains(vertex.at);
        if (point.starts || !is_within) end_stroke();
        if (!is_within) continue;
        if (point.group != last_group) until = faded_until(point.group, now);
        last_group = point.group;
        const double freshness = std::clamp(1 - (until - point.time) / trail_s_, 0.0, 1.0);
        constexpr double thinnest = 0.55;
        vertex.alpha = static_cast<float>(std::pow(freshness, fading));
        vertex.width = static_cast<float>(thinnest + (1 - thinnest) * freshness);
        vertex.glow = static_cast<float>(std::pow(freshness, 4));
        stroke.vertices.push_back(vertex);
    }
    end_stroke();
}

namespace {

/// Adds the part of a line that lies in the area, if any.
void add_line(Point from, Point to, float radius, Color color, const Area& area, DisplayList& list) {
    const auto within = clip_segment(area, from.x, from.y, to.x, to.y);
    if (!within) return;
    const auto at = [&](double share) {
        return Point{static_cast<float>(std::lerp(from.x, to.x, share)),
                     static_cast<float>(std::lerp(from.y, to.y, share))};
    };
    list.push_back(Capsule{at(within->from), at(within->to), radius, color});
}

class PendulumLayer final : public Layer {
public:
    PendulumLayer(const FilmState& state, const PendulumPanel& panel) : Layer(state), panel_(panel) {
        for (const auto& pendulum : pendulums_) {
            heaviest_ = std::max(heaviest_, std::ranges::max(pendulum.mass));
            paths_.push_back({{state.scene, style_, pendulum.trail, px(style_.width.trail)}, std::nullopt});
        }
    }

    void backdrop(DisplayList& list) const override {
        const float u = layout_.unit;
        const auto& area = panel_.area;
        if (!video_.transparent)
            list.push_back(Box{area.left, area.top, area.right, area.bottom, 14 * u, theme_.panel});
        if (video_.view.follow == 0) draw_surroundings(list);
    }

    void add() override {
        for (const auto k : panel_.shown)
            if (video_.trail_s > 0) extend(paths_[k], bobs(k).back());
    }

    /// The last pendulum behind: trails, rods, pivots and bobs; of many, the last bobs are on top.
    void frame(DisplayList& list) const override {
        if (video_.view.follow > 0) draw_surroundings(list);
        const auto& shown = panel_.shown;
        const bool alone = !is_ensemble_ && shown.size() == 1;
        // the other pendulum, faint and behind; this side hides it as long as both move together
        if (alone && shows("twin") && !state_.scene.is_single() && !coincide()) {
            const std::size_t other = 1 - shown.front();
            const Color ghost = pendulums_[other].ghost;
            draw_lines(other, 0.7f * layout_.rod_radius, ghost, list);
            for (std::size_t i = 0; has_bobs_ && i < bobs(other).size(); ++i)
                draw_disc(at(bobs(other)[i]), bob_radius(other, i), ghost, list);
        }
        for (auto k = shown.rbegin(); k != shown.rend(); ++k) draw_trail(*k, list);
        for (auto k = shown.rbegin(); k != shown.rend(); ++k) {
            const auto& pendulum = pendulums_[*k];
            draw_lines(*k, layout_.rod_radius, pendulum.rod, list);
            if (!is_ensemble_) draw_pivots(pendulum.side, list);
            if (!is_many_) draw_bobs(*k, list);
        }
        if (is_ensemble_) draw_pivots(state_.scene.a, list);
        for (auto k = shown.rbegin(); is_many_ && has_bobs_ && k != shown.rend(); ++k)
            draw_disc(at(bobs(*k).back()), bob_radius(0, bobs(0).size() - 1), pendulums_[*k].color, list);
    }

private:
    struct Path {
        Trail trail;
        std::optional<std::pair<Bob<double>, double>> last{};  // the last bob and its time, s
    };

    /// Adds the path from the last bob to this one: a cubic through both with their velocities, in pieces of a few
    /// pixels.
    void extend(Path& path, const Bob<double>& bob) const {
        const float piece = std::max(8 * layout_.unit, 2.0f), minimum = std::max(1.5f * layout_.unit, 0.5f);  // px
        const double now = state_.time();
        const auto go_on = [&](Point to, double time) {
            if (const auto end = path.trail.end(); !end || distance(to, *end) >= minimum) path.trail.add(to, time, now);
        };
        if (path.last) {
            const auto& [from, from_time] = *path.last;
            const double dt = now - from_time;
            const int pieces =
                std::clamp(static_cast<int>(std::ceil(distance(still_at(from), still_at(bob)) / piece)), 1, 32);
            for (int i = 1; i <= pieces; ++i) {
                const double s = static_cast<double>(i) / pieces;
                go_on(panel_.at(hermite(from.x, from.vx, bob.x, bob.vx, dt, s),
                                hermite(from.y, from.vy, bob.y, bob.vy, dt, s)),
                      from_time + s * dt);
            }
        } else {
            go_on(still_at(bob), now);
        }
        path.last = {bob, now};
    }

    void draw_trail(std::size_t k, DisplayList& list) const {
        const auto& bob = bobs(k).back();
        auto ahead = paths_[k];
        if (state_.is_between() && ahead.last) extend(ahead, bob);
        ahead.trail.draw(panel_.area, state_.time(), still_at(bob), list, shift());
    }

    bool coincide() const {
        const auto same_bob = [&](const Bob<double>& a, const Bob<double>& b) {
            return a.mass == b.mass && distance(at(a), at(b)) < 0.1f;  // px
        };
        const auto same_line = [](const MechanismLine& a, const MechanismLine& b) {
            return a.kind == b.kind && a.from == b.from && a.to == b.to;
        };
        return std::ranges::equal(bobs(0), bobs(1), same_bob) &&
               std::ranges::equal(state_.scene.a.lines, state_.scene.b.lines, same_line);
    }

    /// Bobs with a contrasting rim. The last one of a long chain is visible, except in an ensemble.
    void draw_bobs(std::size_t k, DisplayList& list) const {
        for (std::size_t i = 0; has_bobs_ && i < bobs(k).size(); ++i) {
            const bool last = i + 1 == bobs(k).size();
            const float radius = std::max(bob_radius(k, i), last && !is_ensemble_ ? layout_.last_bob_radius : 0);
            const float rim = std::min(std::max(2 * layout_.unit, 0.75f), 0.3f * radius);
            if (!video_.transparent) draw_disc(at(bobs(k)[i]), radius + rim, theme_.panel, list);
            draw_disc(at(bobs(k)[i]), radius, last ? pendulums_[k].color : pendulums_[k].bob, list,
                      last ? style_.glow : 0);
        }
    }

    /// Rods, and springs as thin zigzags.
    void draw_lines(std::size_t k, float radius, Color color, DisplayList& list) const {
        if (!shows("rods") || !(radius > 0)) return;
        const auto& side = pendulums_[k].side;
        const auto end_at = [&](const End<double>& end) {
            if (const auto* bob = std::get_if<std::size_t>(&end)) return at(bobs(k)[*bob]);
            return place_at(side, std::get<Place<double>>(end));
        };
        const auto draw = [&](Point from, Point to, float width) {
            add_line(from, to, width, color, panel_.area.grown(-width, -width), list);
        };
        for (const auto& line : side.lines) {
            if (line.kind == MechanismLine::Kind::rod) draw(end_at(line.from), end_at(line.to), line.width * radius);
            if (line.kind != MechanismLine::Kind::spring) continue;
            constexpr int turns = 16;
            const Point from = end_at(line.from), to = end_at(line.to), along{to.x - from.x, to.y - from.y};
            const float length = std::max(distance(from, to), 1.0f), swing = 0.5f * layout_.bob_radius / length;
            Point last = from;
            for (int i = 1; i <= turns; ++i) {
                const float share = (static_cast<float>(i) - 0.5f) / turns, aside = i % 2 == 0 ? swing : -swing;
                const Point next{from.x + share * along.x - aside * along.y,
                                 from.y + share * along.y + aside * along.x};
                draw(last, next, 0.45f * radius);
                last = next;
            }
            draw(last, to, 0.45f * radius);
        }
    }

    /// The position of a fixed end; for a chain, of the pivot, which may move.
    Point place_at(const Side& side, const Place<double>& place) const {
        const auto& pivot = state_.seen(side).pivot;
        return at(place[0] + pivot.x, place[1] + pivot.y);
    }

    void draw_slots(const Side& side, DisplayList& list) const {
        const float width = px(style_.width.grid);
        const auto& color = theme_.grid;
        if (!(width > 0)) return;
        for (const auto& line : side.lines) {
            const auto *from = std::get_if<Place<double>>(&line.from), *to = std::get_if<Place<double>>(&line.to);
            if (!from) continue;
            const Point start = at(*from);
            if (line.kind == MechanismLine::Kind::slot_circle)
                list.push_back(Ring{start, panel_.px_per_m * static_cast<float>(line.radius), width, color});
            if (line.kind != MechanismLine::Kind::slot_line || !to) continue;
            // extended beyond both ends to the edges of the panel
            const Point end = at(*to), along{end.x - start.x, end.y - start.y};
            const float far = (panel_.area.width() + panel_.area.height()) / std::max(distance(start, end), 1e-3f);
            add_line({start.x - far * along.x, start.y - far * along.y},
                     {start.x + far * along.x, start.y + far * along.y}, width / 2, color, panel_.area, list);
        }
    }

    void draw_pivots(const Side& side, DisplayList& list) const {
        if (!shows("rods") || !(layout_.rod_radius > 0)) return;
        const float radius =
            std::max({0.4f * layout_.bob_radius, 0.5f * layout_.last_bob_radius, 0.012f * layout_.reach});
        for (const auto& place : pivots_of(side)) draw_disc(place_at(side, place), radius, theme_.pivot, list);
    }

    /// A disc; it is not drawn if the run diverges and it leaves the panel.
    void draw_disc(Point at, float radius, Color color, DisplayList& list, float glow = 0) const {
        // with a view set by the preset, nothing is drawn outside the panel
        const float edge = video_.view.height_m || video_.view.center_m || video_.view.follow > 0 ? radius : 0;
        if (panel_.area.grown(-edge, -edge).contains(at))
            list.push_back(Capsule{.from = at, .to = at, .radius = radius, .color = color, .glow = glow});
    }

    /// Radius in px: area proportional to mass, with a visible minimum.
    float bob_radius(std::size_t k, std::size_t bob) const {
        const auto share = px(std::sqrt(pendulums_[k].mass[bob] / heaviest_));
        return std::max(layout_.bob_radius * share, px(pendulums_[k].least_bob()) * layout_.rod_radius);
    }

    const Bobs<double>& bobs(std::size_t k) const { return state_.bobs(k); }
    bool shows(std::string_view part) const { return video_.shows(part); }
    /// The circle that the outstretched chain reaches, if the panel contains it, and slots.
    void draw_surroundings(DisplayList& list) const {
        const float reach = layout_.reach * panel_.px_per_m / layout_.panels.front().px_per_m;
        const Point pivot = at(0, 0);
        const bool is_within =
            panel_.area.contains(Area{pivot.x - reach, pivot.y - reach, pivot.x + reach, pivot.y + reach});
        if (reach > 0 && is_within && shows("circle") && style_.width.grid > 0)
            list.push_back(Ring{pivot, reach, px(style_.width.grid), theme_.grid});
        for (const auto k : panel_.shown) draw_slots(pendulums_[k].side, list);
    }

    /// The shift of all that is drawn, px, if the view follows a mass.
    Point shift() const {
        if (video_.view.follow == 0) return {};
        const auto& bob = bobs(panel_.shown.front())[static_cast<std::size_t>(video_.view.follow - 1)];
        const Point from = panel_.at(bob.x, bob.y);
        return {panel_.center.x - from.x, panel_.center.y - from.y};
    }
    Point at(double x, double y) const {
        const Point to = panel_.at(x, y), by = shift();
        return {to.x + by.x, to.y + by.y};
    }
    Point at(const Bob<double>& bob) const { return at(bob.x, bob.y); }
    Point at(const Place<double>& place) const { return at(place[0], place[1]); }
    /// Position without shift; trails are shifted when they are drawn.
    Point still_at(const Bob<double>& bob) const { return panel_.at(bob.x, bob.y); }

    const PendulumPanel& panel_;
    const std::vector<ShownPendulum> pendulums_ = shown_pendulums(state_.scene, style_, panel_.shown.size() > 1);
    const bool is_ensemble_ = !state_.scene.members.empty(), is_many_ = size_of_many(pendulums_.size()) < 1;
    const bool has_bobs_ = shows("bobs") && layout_.bob_radius > 0;
    double heaviest_ = 1e-300;  // kg
    std::vector<Path> paths_;
};

constexpr double degree = pi / 180;

/// The fraction of the interval between two samples at which an angle passes a whole number of turns upwards, if it
/// does.
std::optional<double> upward_passage(double from, double to) {
    const double turn = 2 * pi * std::floor(to / (2 * pi));
    return turn > from ? std::optional((turn - from) / (to - from)) : std::nullopt;
}

class PhaseLayer final : public Layer {
public:
    PhaseLayer(const FilmState& state, const PhasePanel& panel)
        : Layer(state), panel_(panel), trails_{trail_of(0), trail_of(1)} {}

    void backdrop(DisplayList& list) const override {
        const Area &area = panel_.area, around = panel_.panel;
        if (!video_.transparent)
            list.push_back(Box{around.left, around.top, around.right, around.bottom, 14 * layout_.unit, theme_.panel});
        const bool is_low = area.height() < 2 * px(style_.font.axis);  // its numbers would touch those of the angles
        add_axis(panel_.angle, area, around, {.edge = Edge::bottom}, list, 90);
        add_axis(panel_.rate, area, around, {.edge = Edge::left, .has_numbers = !is_low}, list);
        const auto heading = fmt::format("ω{0}, °/s, against θ{0}, °{1}", subscript(link_ + 1),
                                         video_.phase == PhaseKind::section ? ", as θ₁ passes 0 upwards" : "");
        const auto fits = fitted_text(layout_, heading, px(style_.font.strip), Weight::regular, around.width());
        list.push_back(label(fits.text, {around.left, around.top - 12 * layout_.text}, fits.size, theme_.text));
    }

    void add() override {
        for (std::size_t side = 0; side < 2; ++side)
            video_.phase == PhaseKind::rate
                ? trails_[side].add(at(state_.bobs(side)[link_]), state_.time(), state_.time())
                : add_to_section(side);
    }
    void frame(DisplayList& list) const override {
        const float dot = px(1.2 * style_.width.trace), head = std::max(2.3f * px(style_.width.trace), 2.0f);
        for (std::size_t side = 2; side-- > 0;) {
            const auto color = theme_.sides[side];
            for (const auto& point : section_[side]) list.push_back(Capsule{point, point, dot, color.with_alpha(0.8f)});
            if (video_.phase != PhaseKind::rate) continue;
            const Point now = at(state_.bobs(side)[link_]);
            auto trail = trails_[side];
            if (state_.is_between()) trail.add(now, state_.time(), state_.time());
            trail.draw(panel_.area, state_.time(), std::nullopt, list);
            list.push_back(Capsule{now, now, head, color});
        }
    }

private:
    Point at(double theta, double omega) const {
        return {panel_.angle.at(std::remainder(theta, 2 * pi) / degree), panel_.rate.at(omega / degree)};
    }
    Point at(const Bob<double>& bob) const { return at(bob.theta, bob.omega); }
    Trail trail_of(std::size_t side) const {
        // a path that leaves at +180° continues at -180°
        return {state_.scene, style_, theme_.sides[side], px(style_.width.trail), panel_.area.width() / 2};
    }
    /// Adds a point if the path since the last sample crosses the section.
    void add_to_section(std::size_t side) {
        const auto& bobs = state_.bobs(side);
        if (const auto& last = last_bobs_[side]) {
            if (const auto share = upward_passage((*last)[0].theta, bobs[0].theta)) {
                const auto &from = (*last)[link_], &to = bobs[link_];
                section_[side].push_back(
                    at(std::lerp(from.theta, to.theta, *share), std::lerp(from.omega, to.omega, *share)));
            }
        }
        last_bobs_[side] = bobs;
    }

    const PhasePanel& panel_;
    const std::size_t link_ = static_cast<std::size_t>(video_.phase_link - 1);
    std::array<Trail, 2> trails_;
    std::array<std::optional<Bobs<double>>, 2> last_bobs_;  // for a section
    std::array<std::vector<Point>, 2> section_;
};

}  // namespace

std::unique_ptr<Layer> make_pendulum_layer(const FilmState& state, const PendulumPanel& panel) {
    return std::make_unique<PendulumLayer>(state, panel);
}

std::vector<std::unique_ptr<Layer>> layers_of(const FilmState& state) {
    std::vector<std::unique_ptr<Layer>> layers;
    for (const auto& panel : state.layout.panels) layers.push_back(make_pendulum_layer(state, panel));
    if (const auto& phase = state.layout.phase) layers.push_back(std::make_unique<PhaseLayer>(state, *phase));
    for (const auto& strip : state.layout.strips) layers.push_back(make_strip_layer(state, strip));
    return layers;
}

}  // namespace doppel

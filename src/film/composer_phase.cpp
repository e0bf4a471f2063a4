#include "film/composer.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Within ±180°, in degrees.
double wrapped(double rad) {
    return std::remainder(rad, 2 * pi) * 180 / pi;
}

/// Between two values with their slopes, at `share` of the way (Hermite); `dt` = the way's time.
double between(double from, double slope, double to, double end_slope, double dt, double share) {
    const double s = share, r = 1 - s;
    return (1 + 2 * s) * r * r * from + s * r * r * dt * slope + s * s * (3 - 2 * s) * to - s * s * r * dt * end_slope;
}

/// Where in the way between two samples θ1 passes a whole number of turns upwards, 0…1; nothing where it does not.
std::optional<double> upward_passage(const Bob<double>& from, const Bob<double>& to, double dt) {
    const double turns = std::floor(to.theta / (2 * pi));
    if (!(turns > std::floor(from.theta / (2 * pi)))) return std::nullopt;
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        const bool beyond = between(from.theta, from.omega, to.theta, to.omega, dt, middle) >= 2 * pi * turns;
        (beyond ? high : low) = middle;
    }
    return high;
}

}  // namespace

void Composer::compose_phase_backdrop(DisplayList& list) const {
    const auto& phase = *layout_.phase;
    const auto& style = layout_.style;
    const auto& theme = style.theme;
    const float t = layout_.text, u = layout_.unit;
    const auto size = static_cast<float>(style.font.axis), line = static_cast<float>(style.width.grid);
    const Area& area = phase.area;
    const Area around{layout_.panels.back().area};
    if (!scene_.preset.video.transparent) {
        // the panel that the axes lie in: as large as the pendulums', beside or below it
        const bool below = area.top > around.bottom;
        const float left = below ? around.left : area.left - std::round(96 * t),
                    top = below ? area.top - std::round(66 * t) : around.top;
        list.push_back(Box{left, top, left + around.width(), top + around.height(), 14 * u, theme.panel});
    }
    for (const double degrees : {-180.0, -90.0, 0.0, 90.0, 180.0}) {
        const float x = phase.angle.at(degrees);
        list.push_back(Capsule{{x, area.top}, {x, area.bottom}, line / 2, theme.grid});
        list.push_back(Label{fmt::format("{:g}°", degrees),
                             {x, area.bottom + 1.5f * size},
                             size,
                             Align::center,
                             Weight::regular,
                             theme.quiet_text});
    }
    for (const auto& tick : round_ticks(phase.rate, 3 * size)) {
        const float y = phase.rate.at(tick.value);
        list.push_back(Capsule{{area.left, y}, {area.right, y}, line / 2, theme.grid});
        list.push_back(Label{
            tick.text, {area.left - 12 * t, y + 0.36f * size}, size, Align::right, Weight::regular, theme.quiet_text});
    }
    const auto& video = scene_.preset.video;
    const auto link = subscript(static_cast<std::size_t>(video.phase_link));
    const auto heading = video.phase == PhaseKind::section
                             ? fmt::format("ω{0} over θ{0}, °/s, as θ₁ passes 0 upwards", link)
                             : fmt::format("ω{0} over θ{0}, °/s", link);
    const float fits =
        fitting_size(heading, static_cast<float>(style.font.strip), Weight::regular, area.width() + 20 * t);
    list.push_back(Label{heading, {area.left, area.top - 20 * t}, fits, Align::left, Weight::regular, theme.text});
}

/// The path of a link in phase space, or a point of the section where the way from the last sample crosses it.
void Composer::extend_phase(std::size_t side, const Bobs<double>& bobs, double time) {
    const auto& phase = *layout_.phase;
    const auto& video = scene_.preset.video;
    const auto link = static_cast<std::size_t>(video.phase_link - 1);
    const auto at = [&](double theta, double omega) {
        return Point{phase.angle.at(wrapped(theta)), phase.rate.at(omega * 180 / pi)};
    };
    if (video.phase == PhaseKind::rate) {
        extend(phase_trails_[side], at(bobs[link].theta, bobs[link].omega), time);
        return;
    }
    if (const auto& last = last_bobs_[side]) {
        const double dt = 1 / scene_.preset.sample_hz.value();
        if (const auto share = upward_passage((*last)[0], bobs[0], dt)) {
            const auto &from = (*last)[link], &to = bobs[link];
            const double theta = between(from.theta, from.omega, to.theta, to.omega, dt, *share);
            section_[side].push_back(at(theta, std::lerp(from.omega, to.omega, *share)));
        }
    }
    last_bobs_[side] = bobs;
}

void Composer::compose_phase(DisplayList& list) const {
    const auto& phase = *layout_.phase;
    const auto& style = layout_.style;
    const auto dot = static_cast<float>(1.2 * style.width.trace);
    for (std::size_t side = 2; side-- > 0;) {
        const auto color = style.theme.sides[side];
        for (const auto& point : section_[side]) list.push_back(Capsule{point, point, dot, color.with_alpha(0.8f)});
        // a path that leaves at ±180° comes back at the other end: a piece for each
        Trail piece;
        const auto& trail = phase_trails_[side];
        for (std::size_t i = 0; i < trail.size(); ++i) {
            piece.push_back(trail[i]);
            const bool jumps =
                i + 1 < trail.size() && std::abs(trail[i + 1].at.x - trail[i].at.x) > phase.area.width() / 2;
            if (!jumps && i + 1 < trail.size()) continue;
            compose_trail(side, phase.area, std::nullopt, piece, list);
            piece.clear();
        }
        const auto& bob = seen(side).bobs[static_cast<std::size_t>(scene_.preset.video.phase_link - 1)];
        const Point head{phase.angle.at(wrapped(bob.theta)), phase.rate.at(bob.omega * 180 / pi)};
        if (scene_.preset.video.phase == PhaseKind::rate)
            list.push_back(Capsule{head, head, std::max(2.3f * static_cast<float>(style.width.trace), 2.0f), color});
    }
}

}  // namespace doppel

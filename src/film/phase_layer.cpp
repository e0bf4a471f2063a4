#include "film/layer.hpp"
#include "numeric/state.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

double degrees(double rad) {
    return rad * 180 / pi;
}

/// The fraction of the interval between two samples at which θ1 passes a whole number of turns upwards, if it does.
std::optional<double> upward_passage(const Bob<double>& from, const Bob<double>& to, double dt) {
    const double turns = std::floor(to.theta / (2 * pi));
    if (!(turns > std::floor(from.theta / (2 * pi)))) return std::nullopt;
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        const bool beyond = hermite(from.theta, from.omega, to.theta, to.omega, dt, middle) >= 2 * pi * turns;
        (beyond ? high : low) = middle;
    }
    return high;
}

class PhaseLayer final : public Layer {
public:
    PhaseLayer(const FilmState& state, const PhasePanel& panel)
        : Layer(state), panel_(panel), trails_{trail_of(0), trail_of(1)} {}

    void backdrop(DisplayList& list) const override {
        const Area &area = panel_.area, around = panel_.panel;
        if (!video_.transparent)
            list.push_back(Box{around.left, around.top, around.right, around.bottom, 14 * layout_.unit, theme_.panel});
        auto style = axis_style();
        add_axis(panel_.angle, area, around, style, list, 90);
        style.edge = AxisStyle::Edge::left;
        add_axis(panel_.rate, area, around, style, list);
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
        return {panel_.angle.at(degrees(std::remainder(theta, 2 * pi))), panel_.rate.at(degrees(omega))};
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
            const double dt = state_.time() - last_time_;
            if (const auto share = upward_passage((*last)[0], bobs[0], dt)) {
                const auto &from = (*last)[link_], &to = bobs[link_];
                const double theta = hermite(from.theta, from.omega, to.theta, to.omega, dt, *share);
                section_[side].push_back(at(theta, std::lerp(from.omega, to.omega, *share)));
            }
        }
        last_bobs_[side] = bobs;
        if (side == 1) last_time_ = state_.time();
    }

    const PhasePanel& panel_;
    const VideoSpec& video_ = state_.scene.preset.video;
    const std::size_t link_ = static_cast<std::size_t>(video_.phase_link - 1);
    std::array<Trail, 2> trails_;
    std::array<std::optional<Bobs<double>>, 2> last_bobs_;  // for a section
    std::array<std::vector<Point>, 2> section_;
    double last_time_ = 0;  // s
};

}  // namespace

std::unique_ptr<Layer> make_phase_layer(const FilmState& state, const PhasePanel& panel) {
    return std::make_unique<PhaseLayer>(state, panel);
}

}  // namespace doppel

#include "film/layer.hpp"
#include "film/strips.hpp"
#include "plot/labels.hpp"
#include "render/stroke.hpp"
#include "scene/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace doppel {
namespace {

class StripLayer final : public Layer {
public:
    StripLayer(const FilmState& state, std::size_t index) : Layer(state), index_(index) {}

    void backdrop(DisplayList& list) const override;
    void add() override {
        const auto now = curves();
        traces_.resize(now.size());
        for (std::size_t k = 0; k < now.size(); ++k) extend(traces_[k], now[k]);
    }
    void frame(DisplayList& list) const override;

private:
    std::vector<StripCurve> curves() const {
        return strip_curves(strip_.kind, state_.scene, state_.snapshot.pair, state_.outcome.start_distance, style_);
    }
    /// A curve begins where it enters its axis.
    void extend(Trace& trace, const StripCurve& now) const {
        if (now.value && !(trace.is_empty() && *now.value < strip_.value.low))
            trace.add({strip_.time.at(state_.time()), strip_.value.at(*now.value)});
    }
    /// Whether this strip shows the marks of the pair: that of the distance, otherwise the first.
    bool is_of_pair() const {
        const auto of_distance = std::ranges::find(layout_.strips, StripKind::distance, &StripLayout::kind);
        return of_distance == layout_.strips.end() ? index_ == 0 : strip_.kind == StripKind::distance;
    }
    void draw_line(const TimeMark& mark, DisplayList& list) const;
    void draw_text(const TimeMark& mark, float& foot, DisplayList& list) const;

    const std::size_t index_;
    const StripLayout& strip_ = layout_.strips[index_];
    std::vector<Trace> traces_;  // one for each curve
};

void StripLayer::backdrop(DisplayList& list) const {
    const auto& area = strip_.area;
    const float em = px(style_.font.axis), line = px(style_.width.grid);
    // times after the predictability limit are dimmed
    if (const auto limit = state_.scene.horizon())
        list.push_back(Box{strip_.time.at(*limit), area.top, area.right, area.bottom, 0, theme_.panel});
    auto style = axis_style();
    style.has_numbers = strip_.cell.bottom > area.bottom + em;
    style.unit = " s";
    add_axis(strip_.time, area, strip_.cell, style, list);
    style.edge = AxisStyle::Edge::left;
    style.has_numbers = true;
    add_axis(strip_.value, area, strip_.cell, style, list);
    if (line > 0) {
        list.push_back(vertical_line(area.left, area.top, area.bottom, line, theme_.frame));
        list.push_back(horizontal_line(area.bottom, area.left, area.right, line, theme_.frame));
    }
    if (const auto& proof = state_.scene.certificate)  // a band along the axis
        list.push_back(Box{area.left, area.bottom - 0.25f * em, strip_.time.at(proof->run_until_s()), area.bottom, 0,
                           theme_.trace.with_alpha(0.5f)});
    for (const auto& mark : limits_of(state_.scene)) draw_line(mark, list);
}

/// A dashed vertical line.
void StripLayer::draw_line(const TimeMark& mark, DisplayList& list) const {
    const float bottom = strip_.area.bottom, dash = 5 * layout_.text;
    for (float top = strip_.area.top; style_.width.mark > 0 && top < bottom; top += 2 * dash)
        list.push_back(vertical_line(strip_.time.at(mark.time_s), top, std::min(top + dash, bottom),
                                     px(style_.width.mark), theme_.quiet_text));
}

/// The text at the foot of a line, where curves are high up, above the texts before: beside the line, or on separate
/// lines if there is little space.
void StripLayer::draw_text(const TimeMark& mark, float& foot, DisplayList& list) const {
    const auto& [time, text] = mark;
    const auto& area = strip_.area;
    const float t = layout_.text, size = px(style_.font.strip), x = strip_.time.at(time), gap = 10 * t;
    const float width = text_width(text, size), right = area.right - x - 2 * gap, left = x - area.left - 2 * gap;
    const bool is_right = right >= std::min(width, left);
    const auto rows = wrapped(text, size, Weight::regular, std::clamp(is_right ? right : left, 5 * size, area.width()));
    for (auto words = rows.rbegin(); words != rows.rend(); ++words, foot -= 1.2f * size) {
        const float row = text_width(*words, size), first = area.left + 2 * t;
        const float from =
            std::clamp(is_right ? x + gap : x - gap - row, first, std::max(first, area.right - row - 2 * t));
        // no grid line crosses the text
        if (!state_.scene.preset.video.transparent)
            list.push_back(Box{from - 4 * t, foot - 0.9f * size, from + row + 4 * t, foot + 0.28f * size, 0,
                               theme_.background.with_alpha(0.85f)});
        list.push_back(label(*words, {from, foot}, size, theme_.text));
    }
}

void StripLayer::frame(DisplayList& list) const {
    const auto now = curves();
    const auto& area = strip_.area;
    for (auto& words : placed_caption(strip_, state_.scene, layout_, now, state_.outcome.start_distance == 0))
        list.push_back(std::move(words));
    auto marks = is_of_pair() ? limits_of(state_.scene) : std::vector<TimeMark>();
    if (const auto since = state_.outcome.divergence.since(); since && is_of_pair()) {
        marks.push_back({*since, fmt::format("diverged at {:.1f} s{}", *since, true_divergence_words(state_.scene))});
        draw_line(marks.back(), list);
    }
    const float x = strip_.time.at(state_.time());
    if (style_.width.mark > 0)
        list.push_back(vertical_line(x, area.top, area.bottom, px(style_.width.mark), theme_.cursor));
    for (std::size_t k = 0; style_.width.trace > 0 && k < now.size(); ++k) {
        auto trace = traces_[k];
        if (state_.is_between()) extend(trace, now[k]);
        list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
    }
    float foot = area.bottom - 0.45f * px(style_.font.strip);
    for (const auto& mark : marks) draw_text(mark, foot, list);  // above all lines
    if (now.size() != 1 || traces_[0].is_empty() || !(style_.width.trace > 0)) return;
    const Point head{x, strip_.value.at(*now[0].value)};
    list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
}

}  // namespace

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, std::size_t index) {
    return std::make_unique<StripLayer>(state, index);
}

}  // namespace doppel

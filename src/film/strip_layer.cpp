#include "film/layer.hpp"
#include "film/strips.hpp"
#include "plot/labels.hpp"
#include "render/stroke.hpp"
#include "scene/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

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
        return strip_curves(strip_.kind, state_.scene, state_.snapshot.pair, state_.outcome.start_distance, theme_,
                            style_.width.trace);
    }
    void extend(Trace& trace, const StripCurve& now) const {
        if (now.value) trace.add({strip_.time.at(state_.time()), strip_.value.at(*now.value)});
    }
    /// Whether this strip shows the marks of the pair: that of the distance, otherwise the first.
    bool is_of_pair() const {
        const auto of_distance = std::ranges::find(layout_.strips, StripKind::distance, &StripLayout::kind);
        return of_distance == layout_.strips.end() ? index_ == 0 : strip_.kind == StripKind::distance;
    }
    /// Vertical lines at times with their texts: no line of a mark crosses a text.
    struct Marks {
        DisplayList lines, texts;
        float foot;  // height above which the next text is placed, px
    };
    void add_mark(Marks& marks, double time, const std::string& text) const;
    Marks limits() const;

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
    const auto add = [&](const Axis& axis, bool across) {
        const auto items = axis_items(axis, spaced_ticks(axis, across, em), area, strip_.cell, style);
        list.insert(list.end(), items.begin(), items.end());
    };
    add(strip_.time, true);
    style.edge = AxisStyle::Edge::left;
    style.has_numbers = true;
    add(strip_.value, false);
    if (line > 0) {
        list.push_back(vertical_line(area.left, area.top, area.bottom, line, theme_.frame));
        list.push_back(horizontal_line(area.bottom, area.left, area.right, line, theme_.frame));
    }
    if (const auto& proof = state_.scene.certificate)  // a band along the axis
        list.push_back(Box{area.left, area.bottom - 0.25f * em, strip_.time.at(proof->run_until_s()), area.bottom, 0,
                           theme_.trace.with_alpha(0.5f)});
    auto marks = limits();
    std::ranges::move(marks.lines, std::back_inserter(list));
}

/// A dashed vertical line at a time, with its text at the foot, where curves are high up. The text is beside the line,
/// or on separate lines if there is little space.
void StripLayer::add_mark(Marks& marks, double time, const std::string& text) const {
    const auto& area = strip_.area;
    auto& [lines, texts, foot] = marks;
    const float t = layout_.text, size = px(style_.font.strip), x = strip_.time.at(time), dash = 5 * t, gap = 10 * t;
    for (float top = area.top; style_.width.mark > 0 && top < area.bottom; top += 2 * dash)
        lines.push_back(
            vertical_line(x, top, std::min(top + dash, area.bottom), px(style_.width.mark), theme_.quiet_text));
    if (!is_of_pair()) return;
    const float width = text_width(text, size), right = area.right - x - 2 * gap, left = x - area.left - 2 * gap;
    const bool is_right = right >= std::min(width, left);
    const auto rows = wrapped(text, size, Weight::regular, std::clamp(is_right ? right : left, 5 * size, area.width()));
    const float widest_line = widest(rows, size);
    const float from = std::clamp(is_right ? x + gap : x - gap - widest_line, area.left + 2 * t,
                                  std::max(area.left + 2 * t, area.right - widest_line - 2 * t));
    for (auto words = rows.rbegin(); words != rows.rend(); ++words, foot -= 1.2f * size) {
        // no grid line crosses the text
        if (!state_.scene.preset.video.transparent)
            texts.push_back(Box{from - 4 * t, foot - 0.9f * size, from + text_width(*words, size) + 4 * t,
                                foot + 0.28f * size, 0, theme_.background.with_alpha(0.85f)});
        texts.push_back(label(*words, {from, foot}, size, theme_.text));
    }
}

/// The marks of the predictability limits, and of the time until which the run is proved.
StripLayer::Marks StripLayer::limits() const {
    Marks marks{{}, {}, strip_.area.bottom - 0.45f * px(style_.font.strip)};
    if (const auto limit = state_.scene.horizon())
        add_mark(marks, *limit, fmt::format("numerical predictability limit {:.1f} s", *limit));
    if (const auto& proof = state_.scene.certificate) {
        const double until = proof->run_until_s();
        add_mark(marks, until, fmt::format("proved until {:.1f} s", std::floor(10 * until) / 10));  // not later
    }
    if (const auto limit = state_.scene.preset.video.model_limit_s)
        add_mark(marks, *limit, fmt::format("predictability limit of the model {:.1f} s", *limit));
    return marks;
}

void StripLayer::frame(DisplayList& list) const {
    const auto now = curves();
    const auto& area = strip_.area;
    for (auto& words : placed_caption(strip_, state_.scene, layout_, now, state_.outcome.start_distance == 0))
        list.push_back(std::move(words));
    auto marks = limits();
    marks.lines.clear();  // are in the backdrop
    if (const auto since = state_.outcome.divergence.since(); since && is_of_pair())
        add_mark(marks, *since, fmt::format("diverged at {:.1f} s", *since));
    for (auto* part : {&marks.lines, &marks.texts}) std::ranges::move(*part, std::back_inserter(list));
    const float x = strip_.time.at(state_.time());
    if (style_.width.mark > 0)
        list.push_back(vertical_line(x, area.top, area.bottom, px(style_.width.mark), theme_.cursor));
    for (std::size_t k = 0; style_.width.trace > 0 && k < now.size(); ++k) {
        auto trace = traces_[k];
        if (state_.is_between()) extend(trace, now[k]);
        list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
    }
    if (now.size() != 1 || !now[0].value || !(style_.width.trace > 0)) return;
    const Point head{x, strip_.value.at(*now[0].value)};
    list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
}

}  // namespace

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, std::size_t index) {
    return std::make_unique<StripLayer>(state, index);
}

}  // namespace doppel

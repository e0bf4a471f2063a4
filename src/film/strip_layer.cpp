#include "film/layer.hpp"
#include "film/layout.hpp"
#include "film/strips.hpp"
#include "render/stroke.hpp"
#include "render/typeface.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

void add_dashed_line(float x, const Area& area, float dash, float width, Color color, DisplayList& list) {
    for (float top = area.top; top < area.bottom; top += 2 * dash)
        list.push_back(vertical_line(x, top, std::min(top + dash, area.bottom), width, color));
}

class StripLayer final : public Layer {
public:
    StripLayer(const FilmState& state, std::size_t index) : Layer(state), index_(index) {}

    void backdrop(DisplayList& list) const override {
        dim_horizon(list);
        draw_axes(list);
        if (index_ == 0 && state_.scene.horizon()) say_horizon(list);
        if (index_ + 1 == layout_.strips.size()) draw_time_labels(list);
    }
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
    /// The words of a line of the caption, from 0 on, at its left.
    float base(int line) const {
        return strip_.base - caption_line * layout_.text * static_cast<float>(strip_.lines - 1 - line);
    }
    /// px between ticks of the time, at least.
    float time_spacing() const { return (strip_.area.width() < 400 * layout_.text ? 50 : 90) * layout_.text; }
    void draw_axes(DisplayList& list) const;
    void dim_horizon(DisplayList& list) const;
    std::string horizon_text() const { return fmt::format("predictability limit {:.1f} s", *state_.scene.horizon()); }
    void say_horizon(DisplayList& list) const;
    void say_horizon_above(DisplayList& list) const;
    void draw_time_labels(DisplayList& list) const;
    void draw_parting(float free_from, DisplayList& list) const;
    float draw_values(const std::vector<StripCurve>& now, DisplayList& list) const;

    const std::size_t index_;
    const StripLayout& strip_ = layout_.strips[index_];
    const StripWords words_ = strip_words(strip_.kind, state_.scene);
    // its first line; what a second line says after the number
    const bool short_ = strip_.lines > 1;
    const std::string name_ = short_ ? (words_.brief.empty() ? words_.what : words_.brief) : words_.in_full();
    const std::string rest_ = short_ && words_.brief.empty() ? words_.how : "";
    const float size_ = px(style_.font.strip);
    std::vector<Trace> traces_;  // by curve
};

void StripLayer::draw_axes(DisplayList& list) const {
    const float t = layout_.text, line = px(style_.width.grid), size = px(style_.font.axis);
    const auto& area = strip_.area;
    for (const auto& tick : axis_ticks(strip_.time, size, time_spacing(), true))
        list.push_back(vertical_line(strip_.time.at(tick.value), area.top, area.bottom, line, theme_.grid));
    bool has_foot = false;
    for (const auto& tick :
         axis_ticks(strip_.value, size, (strip_.kind == StripKind::distance ? 1.7f : 1.5f) * size, false)) {
        const float y = strip_.value.at(tick.value);
        const bool border = y > area.bottom - 0.5f;
        if (tick.text.empty() && !border) continue;
        has_foot |= border;
        list.push_back(horizontal_line(y, area.left, area.right, line, border ? theme_.frame : theme_.grid));
        if (!tick.text.empty())
            list.push_back(
                label(tick.text, {area.left - 12 * t, y + 0.36f * size}, size, theme_.quiet_text, Align::right));
    }
    if (!has_foot) list.push_back(horizontal_line(area.bottom, area.left, area.right, line, theme_.frame));
    const float fits = style_.type.fitting_size(name_, size_, Weight::regular, strip_.caption.width());
    list.push_back(label(name_, {strip_.caption.left, base(0)}, fits, theme_.text));
}

void StripLayer::draw_time_labels(DisplayList& list) const {
    const float t = layout_.text, size = px(style_.font.axis);
    const auto ticks = axis_ticks(strip_.time, size, time_spacing(), true);
    const float margin = static_cast<float>(state_.scene.preset.video.size.width) - layout_.page.right;
    float free_to = layout_.page.right + margin + 20 * t;  // labels keep apart from the one right of them
    for (auto tick = ticks.rbegin(); tick != ticks.rend(); ++tick) {
        // the last one carries the unit; its number stays below the tick as far as the margin allows
        const auto text = tick == ticks.rbegin() ? tick->text + " s" : tick->text;
        const float width = style_.type.width(text, size);
        const float right = std::min(strip_.time.at(tick->value) + width - style_.type.width(tick->text, size) / 2,
                                     layout_.page.right + 0.7f * margin);
        if (right + 10 * t > free_to) continue;
        list.push_back(label(text, {right, layout_.time_labels}, size, theme_.quiet_text, Align::right));
        free_to = right - width;
    }
}

/// What lies beyond the time up to which the pair can be predicted is dimmed.
void StripLayer::dim_horizon(DisplayList& list) const {
    const auto horizon = state_.scene.horizon();
    if (!horizon) return;
    const auto& area = strip_.area;
    const float x = strip_.time.at(*horizon);
    list.push_back(Box{x, area.top, area.right, area.bottom, 0, theme_.panel});
    add_dashed_line(x, area, 3 * layout_.text, px(style_.width.mark), theme_.quiet_text, list);
}

/// That time, beside its line at the foot: traces are high up by then. No line of the grid crosses the words.
void StripLayer::say_horizon(DisplayList& list) const {
    const float t = layout_.text, size = 0.9f * size_, x = strip_.time.at(*state_.scene.horizon());
    const auto& area = strip_.area;
    const auto text = horizon_text();
    const float width = style_.type.width(text, size);
    const bool left = x - area.left > width + 20 * t, right = area.right - x > width + 20 * t;
    if (!left && !right) return;  // above the strip, until they diverge
    const Point at{left ? x - 10 * t - width : x + 10 * t, area.bottom - 10 * t};
    if (!state_.scene.preset.video.transparent)
        list.push_back(Box{at.x - 4 * t, at.y - 0.82f * size, at.x + width + 4 * t, at.y + 0.28f * size, 0,
                           left ? theme_.background : theme_.panel});
    list.push_back(label(text, at, size, theme_.quiet_text));
}

/// The same in the caption, where when they parted will stand.
void StripLayer::say_horizon_above(DisplayList& list) const {
    const float size = 0.9f * size_, x = strip_.time.at(*state_.scene.horizon());
    const auto text = horizon_text();
    const float width = style_.type.width(text, size), beside = width + 20 * layout_.text;
    if (strip_.lines < 3 || x - strip_.area.left > beside || strip_.area.right - x > beside) return;
    const float fits = style_.type.fitting_size(text, size, Weight::regular, strip_.caption.width());
    list.push_back(label(text, {strip_.caption.left, strip_.base}, fits, theme_.quiet_text));
}

/// The moment of divergence: a dashed line, and when it was above it, right of what is there already.
void StripLayer::draw_parting(float free_from, DisplayList& list) const {
    const float x = strip_.time.at(*state_.outcome.parting.since());
    add_dashed_line(x, strip_.area, 6 * layout_.text, px(style_.width.mark), theme_.quiet_text, list);
    const auto text = fmt::format("diverged at {:.1f} s", *state_.outcome.parting.since());
    const auto& caption = strip_.caption;
    if (strip_.lines > 2) return list.push_back(label(text, {caption.left, strip_.base}, size_, theme_.text));
    if (strip_.lines == 2)
        return list.push_back(label(text, {caption.right, strip_.base}, size_, theme_.text, Align::right));
    const float half = style_.type.width(text, size_) / 2;
    const float center = std::min(std::max(x, free_from + half), strip_.area.right - half);
    if (center - half < free_from - 14 * layout_.text) return;  // no room: the line alone
    list.push_back(label(text, {center, strip_.base}, size_, theme_.text, Align::center));
}

/// The number now, or which line is which, beside the name or below it. Returns where that ends, px.
float StripLayer::draw_values(const std::vector<StripCurve>& now, DisplayList& list) const {
    const float t = layout_.text, y = base(short_ ? 1 : 0);
    float left = strip_.caption.left + (short_ ? 0 : style_.type.width(name_, size_) + 18 * t);
    const auto say = [&](const std::string& text, Color color, float room) {
        const float size = style_.type.fitting_size(text, size_, Weight::regular, strip_.caption.right - left);
        if (size < 0.6f * size_) return;  // no room
        list.push_back(label(text, {left, y}, size, color));
        left += std::max(room, style_.type.width(text, size) + 14 * t);
    };
    if (strip_.kind == StripKind::distance)
        say(scientific(state_.snapshot.pair.distance), now[0].color, value_room * t);
    else if (strip_.kind == StripKind::exponent && now[0].value)
        say(fmt::format("{:.2f}", *now[0].value), now[0].color, (short_ ? brief_value_room : value_room) * t);
    else if (strip_.kind == StripKind::exponent && state_.outcome.start_distance == 0)
        say(alike_words, theme_.quiet_text, 0);
    else if (const auto none = no_error_words(strip_.kind, state_.scene); !none.empty())
        say(none, theme_.quiet_text, 0);
    else if (!rest_.empty() && strip_.kind != StripKind::exponent)
        say(rest_, theme_.quiet_text, 0);
    for (const auto& value : now)
        if (!value.name.empty()) say(value.name, value.color, 0);
    if (strip_.kind == StripKind::exponent && now[0].value && !rest_.empty()) say(rest_, theme_.quiet_text, 0);
    return left;
}

void StripLayer::frame(DisplayList& list) const {
    const float x = strip_.time.at(state_.time());
    const auto now = curves();
    const float left = draw_values(now, list);
    if (state_.outcome.parting.since() && index_ == 0)
        draw_parting(left, list);
    else if (index_ == 0 && state_.scene.horizon())
        say_horizon_above(list);
    list.push_back(vertical_line(x, strip_.area.top, strip_.area.bottom, px(style_.width.mark), theme_.cursor));
    for (std::size_t k = 0; k < now.size(); ++k) {
        auto trace = traces_[k];
        if (state_.is_between()) extend(trace, now[k]);
        list.push_back(Stroke{.vertices = trace.vertices(), .width = px(now[k].width), .color = now[k].color});
    }
    if (now.size() != 1 || !now[0].value) return;
    const Point head{x, strip_.value.at(*now[0].value)};
    list.push_back(Capsule{head, head, std::max(2.3f * px(style_.width.trace), 2.0f), now[0].color});
}

}  // namespace

std::unique_ptr<Layer> make_strip_layer(const FilmState& state, std::size_t index) {
    return std::make_unique<StripLayer>(state, index);
}

}  // namespace doppel

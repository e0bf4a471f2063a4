#include "film/composer.hpp"
#include "film/survey.hpp"
#include "render/font.hpp"
#include "scene/captions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

/// A line from a to b whose edges fall on pixels: exactly `width` px, not two half-covered rows.
Box vertical_line(float x, float top, float bottom, float width, Color color) {
    const float left = std::round(x - width / 2);
    return {left, top, left + std::max(1.0f, std::round(width)), bottom, 0, color};
}

Box horizontal_line(float y, float left, float right, float width, Color color) {
    const float top = std::round(y - width / 2);
    return {left, top, right, top + std::max(1.0f, std::round(width)), 0, color};
}

void add_dashed_line(float x, const Area& area, float dash, float width, Color color, DisplayList& list) {
    for (float top = area.top; top < area.bottom; top += 2 * dash)
        list.push_back(vertical_line(x, top, std::min(top + dash, area.bottom), width, color));
}

/// The rods of a chain whose forces are shown: all of a short one, the first and the last of a long one.
std::vector<std::size_t> shown_rods(std::size_t rods) {
    constexpr std::size_t most = 3;
    std::vector<std::size_t> shown;
    for (std::size_t k = 0; k < rods; ++k)
        if (rods <= most || k == 0 || k + 1 == rods) shown.push_back(k);
    return shown;
}

}  // namespace

std::string Composer::strip_heading(StripKind kind) const {
    switch (kind) {
        case StripKind::distance:
            return "state-space distance";
        case StripKind::exponent:
            return "Lyapunov exponent so far, 1/s";
        case StripKind::energy:
            return "energy error, of the potential range";
        case StripKind::rod_error:
            return "worst rod error, m";
        case StripKind::rod_force:
            break;
    }
    return "force in the rods, N";
}

std::vector<Composer::StripValue> Composer::strip_values(StripKind kind) const {
    const auto& theme = layout_.style.theme;
    const double width = layout_.style.width.trace;
    // of two lines the first is wider, so that it still shows where both run as one
    const std::array widths{1.5 * width, 0.64 * width};
    std::vector<StripValue> values;
    switch (kind) {
        case StripKind::distance:
            values.push_back({now_.moment.distance, theme.trace, width});
            break;
        case StripKind::exponent:
            values.push_back({exponent_so_far(scene_, now_.moment, start_distance_), theme.trace, width});
            break;
        case StripKind::energy:
            // where damping takes energy no change of it is an error
            for (std::size_t side = 0; side < 2; ++side) {
                const bool conserves = (side == 0 ? scene_.a : scene_.b).conserves_energy;
                const double error = std::abs(seen(side).energy_change) / energy_unit_;
                values.push_back({conserves ? std::optional(error) : std::nullopt, theme.sides[side], widths[side]});
            }
            break;
        case StripKind::rod_error:
            for (std::size_t side = 0; side < 2; ++side)
                values.push_back({seen(side).length_error, theme.sides[side], widths[side]});
            break;
        case StripKind::rod_force:
            for (std::size_t side = 0; side < 2; ++side) {
                const auto& tension = seen(side).tension;
                const auto rods = shown_rods(tension.size());
                for (const auto rod : rods) {
                    // the inner rods paler
                    const float pale = rods.size() < 2 || rod + 1 == tension.size() ? 0 : 0.6f;
                    values.push_back({tension[rod], mixed(theme.sides[side], theme.text, pale), 0.8 * width,
                                      fmt::format("{}{}", side == 0 ? "a" : "b", rod + 1)});
                }
            }
            break;
    }
    return values;
}

void Composer::compose_strip_backdrop(const StripLayout& strip, DisplayList& list) const {
    const float t = layout_.text;
    const auto& style = layout_.style;
    const auto line = static_cast<float>(style.width.grid), size = static_cast<float>(style.font.axis);
    const auto& area = strip.area;
    for (const auto& tick : round_ticks(strip.time, 90 * t))
        list.push_back(vertical_line(strip.time.at(tick.value), area.top, area.bottom, line, style.theme.grid));
    const float label_px = (strip.kind == StripKind::distance ? 1.7f : 1.5f) * size;
    const auto ticks =
        strip.value.logarithmic ? decade_ticks(strip.value, label_px) : round_ticks(strip.value, label_px);
    bool has_foot = false;
    for (const auto& tick : ticks) {
        const float y = strip.value.at(tick.value);
        const bool border = y > area.bottom - 0.5f;
        if (tick.text.empty() && !border) continue;
        has_foot |= border;
        list.push_back(horizontal_line(y, area.left, area.right, line, border ? style.theme.frame : style.theme.grid));
        if (!tick.text.empty())
            list.push_back(Label{tick.text,
                                 {area.left - 12 * t, y + 0.36f * size},
                                 size,
                                 Align::right,
                                 Weight::regular,
                                 style.theme.quiet_text});
    }
    if (!has_foot) list.push_back(horizontal_line(area.bottom, area.left, area.right, line, style.theme.frame));
    list.push_back(Label{strip_heading(strip.kind),
                         {area.left, area.top - 12 * t},
                         static_cast<float>(style.font.strip),
                         Align::left,
                         Weight::regular,
                         style.theme.text});
}

void Composer::compose_time_labels(const StripLayout& strip, DisplayList& list) const {
    const float t = layout_.text;
    const auto ticks = round_ticks(strip.time, 90 * t);
    for (const auto& tick : ticks) {
        const bool last = &tick == &ticks.back();
        const float x = strip.time.at(tick.value);
        // the last one carries the unit, and stays on the page
        const bool at_edge = x > layout_.page.right - 30 * t;
        list.push_back(Label{last ? tick.text + " s" : tick.text,
                             {at_edge ? layout_.page.right : x, layout_.time_labels},
                             static_cast<float>(layout_.style.font.axis),
                             at_edge ? Align::right : Align::center,
                             Weight::regular,
                             layout_.style.theme.quiet_text});
    }
}

void Composer::compose_horizon(DisplayList& list) const {
    const auto horizon = scene_.horizon();
    if (!horizon) return;
    const float t = layout_.text, size = 0.9f * static_cast<float>(layout_.style.font.strip);
    const auto& theme = layout_.style.theme;
    bool said = false;
    for (const auto& strip : layout_.strips) {
        const auto& area = strip.area;
        const float x = strip.time.at(*horizon);
        // what lies beyond is dimmed, as nobody can vouch for it
        list.push_back(Box{x, area.top, area.right, area.bottom, 0, theme.panel});
        add_dashed_line(x, area, 3 * t, static_cast<float>(layout_.style.width.mark), theme.quiet_text, list);
        if (std::exchange(said, true)) continue;
        // at the foot: traces are high up by then
        const auto words = fmt::format("predictable to {:.1f} s", *horizon);
        const bool left = x - area.left > text_width(words, size) + 20 * t;
        list.push_back(Label{words,
                             {x + (left ? -10 : 10) * t, area.bottom - 10 * t},
                             size,
                             left ? Align::right : Align::left,
                             Weight::regular,
                             theme.quiet_text});
    }
}

/// The moment of parting: a dashed line, and when it was above it, right of what is there already.
void Composer::compose_parting(const StripLayout& strip, float free_from, DisplayList& list) const {
    const auto size = static_cast<float>(layout_.style.font.strip);
    const auto& theme = layout_.style.theme;
    const float t = layout_.text, x = strip.time.at(*parted_);
    add_dashed_line(x, strip.area, 6 * t, static_cast<float>(layout_.style.width.mark), theme.quiet_text, list);
    const auto text = fmt::format("parted at {:.1f} s", *parted_);
    const float half = text_width(text, size) / 2;
    const float center = std::clamp(x, free_from + half, std::max(free_from + half, strip.area.right - half));
    list.push_back(Label{text, {center, strip.area.top - 12 * t}, size, Align::center, Weight::regular, theme.text});
}

void Composer::compose_strip(std::size_t index, DisplayList& list) const {
    const auto& strip = layout_.strips[index];
    const auto& style = layout_.style;
    const float t = layout_.text, x = strip.time.at(now());
    const auto size = static_cast<float>(style.font.strip), mark = static_cast<float>(style.width.mark);
    const auto values = strip_values(strip.kind);

    // the number now, or which line is which, beside the heading
    float words = strip.area.left + text_width(strip_heading(strip.kind), size) + 18 * t;
    const auto say = [&](const std::string& text, Color color, float room) {
        list.push_back(Label{text, {words, strip.area.top - 12 * t}, size, Align::left, Weight::regular, color});
        words += std::max(room, text_width(text, size) + 14 * t);
    };
    if (strip.kind == StripKind::distance)
        say(scientific(now_.moment.distance), values[0].color, 110 * t);
    else if (strip.kind == StripKind::exponent && values[0].value)
        say(fmt::format("{:.2f}", *values[0].value), values[0].color, 110 * t);
    else if (strip.kind == StripKind::exponent && start_distance_ == 0)
        say("none: both start alike", style.theme.quiet_text, 0);
    else if (strip.kind == StripKind::energy && !scene_.a.conserves_energy && !scene_.b.conserves_energy)
        say("none: damping takes energy", style.theme.quiet_text, 0);
    for (const auto& value : values)
        if (!value.name.empty()) say(value.name, value.color, 0);

    if (parted_ && index == 0) compose_parting(strip, words, list);
    list.push_back(vertical_line(x, strip.area.top, strip.area.bottom, mark, style.theme.cursor));
    for (std::size_t k = 0; k < values.size(); ++k)
        list.push_back(Stroke{.vertices = traces_[index][k].vertices(),
                              .width = static_cast<float>(values[k].width),
                              .color = values[k].color});
    if (values.size() == 1 && values[0].value) {
        const Point head{x, strip.value.at(*values[0].value)};
        list.push_back(
            Capsule{head, head, std::max(2.3f * static_cast<float>(style.width.trace), 2.0f), values[0].color});
    }
}

}  // namespace doppel

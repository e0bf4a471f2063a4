#include "picture/font.hpp"
#include "scene/composer.hpp"
#include "scene/wording.hpp"

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

constexpr float words_px = 21;  // size of the words above a strip, in a 1920×1080 picture

void add_dashed_line(float x, const Area& area, float dash, float width, Color color, DisplayList& list) {
    for (float top = area.top; top < area.bottom; top += 2 * dash)
        list.push_back(vertical_line(x, top, std::min(top + dash, area.bottom), width, color));
}

}  // namespace

void Composer::compose_strip_backdrop(const StripLayout& strip, const char* heading, float label_px,
                                      DisplayList& list) const {
    const float t = layout_.text, line = std::max(1.4f * layout_.unit, 1.0f);
    const auto& area = strip.area;
    const float size = 20 * t;
    for (const auto& tick : round_ticks(strip.time, 90 * t))
        list.push_back(vertical_line(strip.time.at(tick.value), area.top, area.bottom, line, theme_.grid));
    for (const auto& tick : decade_ticks(strip.value, label_px)) {
        const float y = strip.value.at(tick.value);
        const bool border = y > area.bottom - 0.5f;
        if (tick.text.empty() && !border) continue;
        list.push_back(horizontal_line(y, area.left, area.right, line, border ? theme_.frame : theme_.grid));
        if (!tick.text.empty())
            list.push_back(Label{tick.text,
                                 {area.left - 12 * t, y + 0.36f * size},
                                 size,
                                 Align::right,
                                 Weight::regular,
                                 theme_.quiet_text});
    }
    list.push_back(
        Label{heading, {area.left, area.top - 12 * t}, words_px * t, Align::left, Weight::regular, theme_.text});
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
                             20 * t,
                             at_edge ? Align::right : Align::center,
                             Weight::regular,
                             theme_.quiet_text});
    }
}

void Composer::compose_horizon(DisplayList& list) const {
    const auto horizon = scene_.horizon();
    if (!horizon) return;
    const float t = layout_.text, size = 19 * t;
    bool said = false;
    for (const auto* strip : {&layout_.distance, &layout_.energy}) {
        if (!*strip) continue;
        const auto& area = (*strip)->area;
        const float x = (*strip)->time.at(*horizon);
        // what lies beyond is dimmed, as nobody can vouch for it
        list.push_back(Box{x, area.top, area.right, area.bottom, 0, theme_.panel});
        add_dashed_line(x, area, 3 * t, std::max(1.6f * layout_.unit, 1.0f), theme_.quiet_text, list);
        if (std::exchange(said, true)) continue;
        // at the foot: traces are high up by then
        const auto words = fmt::format("predictable to {:.1f} s", *horizon);
        const bool left = x - area.left > text_width(words, size) + 20 * t;
        list.push_back(Label{words,
                             {x + (left ? -10 : 10) * t, area.bottom - 10 * t},
                             size,
                             left ? Align::right : Align::left,
                             Weight::regular,
                             theme_.quiet_text});
    }
}

void Composer::compose_distance(DisplayList& list) const {
    const auto& strip = *layout_.distance;
    const float t = layout_.text, u = layout_.unit;
    const float x = strip.time.at(scene_.time(now_.sample)), y = strip.value.at(now_.distance);
    const float words = strip.area.left + text_width(distance_heading, words_px * t) + 18 * t,
                baseline = strip.area.top - 12 * t;
    list.push_back(
        Label{scientific(now_.distance), {words, baseline}, words_px * t, Align::left, Weight::regular, theme_.trace});
    if (parted_) {
        // the moment of parting: a dashed line, and when it was above it
        const float at = strip.time.at(*parted_);
        add_dashed_line(at, strip.area, 6 * t, std::max(1.6f * u, 1.0f), theme_.quiet_text, list);
        const auto text = fmt::format("parted at {:.1f} s", *parted_);
        const float half = text_width(text, words_px * t) / 2, room = 110 * t;
        const float center =
            std::clamp(at, words + room + half, std::max(words + room + half, strip.area.right - half));
        list.push_back(Label{text, {center, baseline}, words_px * t, Align::center, Weight::regular, theme_.text});
    }
    list.push_back(vertical_line(x, strip.area.top, strip.area.bottom, std::max(1.6f * u, 1.0f), theme_.cursor));
    list.push_back(Stroke{distance_.vertices(), std::max(2.8f * u, 1.2f), theme_.trace});
    list.push_back(Capsule{{x, y}, {x, y}, std::max(6.5f * u, 2.0f), theme_.trace});
}

void Composer::compose_energy(DisplayList& list) const {
    const auto& strip = *layout_.energy;
    const float u = layout_.unit, x = strip.time.at(scene_.time(now_.sample));
    list.push_back(vertical_line(x, strip.area.top, strip.area.bottom, std::max(1.6f * u, 1.0f), theme_.cursor));
    // the first is wider, so that it still shows where both run as one
    const std::array widths{std::max(4.2f * u, 2.2f), std::max(1.8f * u, 1.0f)};
    for (std::size_t side = 0; side < 2; ++side)
        list.push_back(Stroke{energy_[side].vertices(), widths[side], theme_.sides[side]});
}

}  // namespace doppel

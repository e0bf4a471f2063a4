#include "plot/bar.hpp"

#include "image/colormap.hpp"
#include "plot/text.hpp"
#include "plot/ticks.hpp"
#include "render/font.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr float heading_width = 7.5f;  // em

/// A bar before it has a place: top 0, left 0.
struct Bar {
    Axis axis;  // from its bottom up, px below the top of the panel
    std::vector<Tick> ticks;
    std::vector<std::string> none;  // lines
    float thickness, words_left, width, none_top;
};

Bar make_bar(const HeatMap& map, float height, const PlotStyle& style) {
    Bar bar;
    const float em = style.tick;
    bar.thickness = std::round(0.95f * em);
    bar.words_left = bar.thickness + 0.5f * em;
    bar.axis = fitted_scale(map);
    float none_height = 0;
    if (!map.none_label.empty()) {
        bar.none = wrapped(map.none_label, em, Weight::regular, 6.2f * em);
        none_height = 1.2f * em * static_cast<float>(bar.none.size());
    }
    bar.none_top = height - none_height;
    bar.axis.from = std::round(bar.none.empty() ? height : std::max(bar.none_top - 0.8f * em, 0.3f * height));
    bar.axis.to = 0;
    bar.ticks = chart_ticks(bar.axis, {.size = em, .gap = 0.6f * em, .spacing = 2.4f * em, .across = false});
    float widest = 0;
    for (const Tick& tick : bar.ticks) widest = std::max(widest, text_width(tick.text, em));
    for (const std::string& line : bar.none) widest = std::max(widest, text_width(line, em));
    bar.width = bar.words_left + widest;
    return bar;
}

Image colors(const Bar& bar, float left, float top, float scale) {
    const int rows = std::max(1, static_cast<int>(std::lround(bar.axis.from * scale)));
    auto pixels = std::make_shared<Picture>(Size{1, rows});
    for (int row = 0; row < rows; ++row) {
        const Color color = map_color(1 - (row + 0.5) / rows);
        std::uint8_t* rgba = pixels->at(0, row);
        const float channels[] = {color.r, color.g, color.b, 1};
        std::transform(channels, channels + 4, rgba,
                       [](float c) { return static_cast<std::uint8_t>(std::lround(255 * c)); });
    }
    return {left, top, left + bar.thickness, top + bar.axis.from, std::move(pixels)};
}

/// The label of a bar by itself, in lines above it.
TextBlock bar_heading(const HeatMap& map, const PlotStyle& style) {
    return {wrapped(map.label, style.tick, Weight::regular, heading_width * style.tick), style.tick, Weight::regular,
            style.theme.text};
}

float below_heading(const HeatMap& map, float height, const PlotStyle& style) {
    return std::max(height - bar_heading(map, style).height() - style.tick, 1.0f);
}

}  // namespace

Color none_color(const HeatMap& map, const Theme& theme) {
    return map.none_is_bad ? theme.bad : theme.none;
}

float shared_bar_gutter(const HeatMap& map, float height, const PlotStyle& style) {
    float widest = 0;
    for (const std::string& line : bar_heading(map, style).lines)
        widest = std::max(widest, text_width(line, style.tick));
    return 1.2f * style.tick + std::max(widest, make_bar(map, below_heading(map, height, style), style).width);
}

void draw_shared_bar(const HeatMap& map, const Area& area, float left, const PlotStyle& style, DisplayList& list) {
    bar_heading(map, style).draw({std::round(left + 1.2f * style.tick), area.top}, list);
    Area below = area;
    below.top = std::round(area.bottom - below_heading(map, area.height(), style));
    draw_bar(map, below, left, style, list);
}

float bar_gutter(const HeatMap& map, float height, const PlotStyle& style) {
    return 1.2f * style.tick + make_bar(map, height, style).width;
}

void draw_bar(const HeatMap& map, const Area& area, float left, const PlotStyle& style, DisplayList& list) {
    const Bar bar = make_bar(map, area.height(), style);
    const float em = style.tick, start = std::round(left + 1.2f * em),
                line = std::max(std::round(style.hairline), 1.0f);
    list.push_back(colors(bar, start, area.top, style.scale));
    const auto words = [&](const std::string& text, float middle) {
        list.push_back(Label{text,
                             {start + bar.words_left, area.top + middle + 0.36f * em},
                             em,
                             Align::left,
                             Weight::regular,
                             style.theme.quiet_text});
    };
    for (const Tick& tick : bar.ticks) {
        if (tick.text.empty()) continue;
        const float y = bar.axis.at(tick.value), top = std::round(area.top + y - line / 2);
        list.push_back(
            Box{start + bar.thickness, top, start + bar.thickness + 0.25f * em, top + line, 0, style.theme.frame});
        words(tick.text, y);
    }
    // centred on the tick as all words are, so none is above the panel by more than half a line
    if (bar.none.empty()) return;
    const float top = std::round(area.top + bar.none_top + 0.1f * em);
    list.push_back(
        Box{start, top, start + bar.thickness, top + std::round(0.95f * em), 0, none_color(map, style.theme)});
    for (std::size_t i = 0; i < bar.none.size(); ++i)
        words(bar.none[i], bar.none_top + (0.6f + 1.2f * static_cast<float>(i)) * em);
}

}  // namespace doppel

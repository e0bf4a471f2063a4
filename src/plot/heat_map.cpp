#include "plot/labels.hpp"
#include "plot/panel.hpp"

namespace doppel {
namespace {

/// Sets an opaque pixel.
void set_pixel(Picture& picture, int x, int y, Color color) {
    std::ranges::copy(bytes_of(color.with_alpha(1)), picture.at(x, y));
}

constexpr float heading_width = 7.5f;  // em

/// A colour bar at top 0, left 0.
struct Bar {
    MapScale scale;
    Axis axis = {};  // upwards; px below the top of the panel
    std::vector<Tick> ticks = {};
    std::vector<std::string> none = {};  // lines of text for cells without a value
    float thickness = 0, text_left = 0, width = 0, none_top = 0;
};

Bar make_bar(const HeatMap& map, float height, const PlotStyle& style) {
    Bar bar{.scale = MapScale(map)};
    const float em = style.tick;
    bar.thickness = std::round(0.95f * em);
    bar.text_left = bar.thickness + 0.5f * em;
    bar.axis = bar.scale.axis;
    float none_height = 0;
    if (!map.none_label.empty()) {
        bar.none = wrapped(map.none_label, em, Weight::regular, 6.2f * em);
        none_height = 1.2f * em * static_cast<float>(bar.none.size());
    }
    bar.none_top = height - none_height;
    bar.axis.from = std::round(bar.none.empty() ? height : std::max(bar.none_top - 0.8f * em, 0.3f * height));
    bar.axis.to = 0;
    bar.ticks =
        bar_ticks(bar.axis, {.size = em, .gap = 0.6f * em, .spacing = 2.4f * em, .across = false}, map.threshold);
    bar.width = bar.text_left + std::max(widest(bar.ticks, em), widest(bar.none, em));
    return bar;
}

Image colors(const Bar& bar, float left, float top, float scale) {
    const int rows = std::max(1, static_cast<int>(std::lround(bar.axis.from * scale)));
    auto pixels = std::make_shared<Picture>(Size{1, rows});
    for (int row = 0; row < rows; ++row) set_pixel(*pixels, 0, row, bar.scale.color(1 - (row + 0.5) / rows));
    return {{left, top, left + bar.thickness, top + bar.axis.from}, std::move(pixels)};
}

/// The label of a shared colour bar, as lines above it.
TextBlock bar_heading(const HeatMap& map, const PlotStyle& style) {
    if (!map.shares_bar) return {};
    return {evenly_wrapped(map.label, style.tick, Weight::regular, heading_width * style.tick), style.tick,
            Weight::regular, style.theme.text};
}

float below(const TextBlock& heading, float height, const PlotStyle& style) {
    return heading.lines.empty() ? height : std::max(height - heading.height() - style.tick, 1.0f);
}

}  // namespace

std::vector<Tick> bar_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> threshold) {
    auto ticks = chart_ticks(axis, labels, threshold);
    const double share = threshold ? axis.share(*threshold) : NAN;
    if (!(share >= 0 && share <= 1)) return ticks;
    std::erase_if(ticks, [&](const Tick& tick) {
        return std::abs(axis.at(tick.value) - axis.at(*threshold)) < labels.size + labels.gap;
    });
    ticks.push_back(tick_at(*threshold));
    return ticks;
}

Color none_color(const HeatMap& map, const Theme& theme) {
    return map.none_is_bad ? theme.bad : theme.none;
}

Picture cell_picture(const HeatMap& map, const Theme& theme) {
    Picture picture({static_cast<int>(map.columns), static_cast<int>(map.rows)});
    const MapScale scale(map);
    const Color none = none_color(map, theme);
    for (int y = 0; y < picture.size.height; ++y)
        for (int x = 0; x < picture.size.width; ++x) {
            const auto cell = (map.rows - 1 - static_cast<std::size_t>(y)) * map.columns + static_cast<std::size_t>(x);
            const auto value = static_cast<double>(map.values[cell]);
            const bool has_value = std::isfinite(value) && (value > 0 || !map.logarithmic);
            set_pixel(picture, x, y, has_value ? scale.color(scale.axis.share(value)) : none);
        }
    return picture;
}

Image map_cells(const Plot& plot, const Axis& x, const Axis& y, const Area& area, const Theme& theme) {
    const auto at = [](const Axis& axis, double edge) { return static_cast<float>(axis.pixel(edge)); };
    return {{at(x, *plot.x.low), at(y, *plot.y.high), at(x, *plot.x.high), at(y, *plot.y.low)},
            std::make_shared<Picture>(cell_picture(*plot.map, theme)),
            area};
}

float bar_gutter(const HeatMap& map, float height, const PlotStyle& style) {
    const auto heading = bar_heading(map, style);
    return 1.2f * style.tick +
           std::max(widest(heading.lines, style.tick), make_bar(map, below(heading, height, style), style).width);
}

void draw_bar(const HeatMap& map, Area area, float left, const PlotStyle& style, PageList& list) {
    const auto heading = bar_heading(map, style);
    const float em = style.tick, start = std::round(left + 1.2f * em);
    heading.draw({start, area.top}, list);
    area.top = std::round(area.bottom - below(heading, area.height(), style));
    const Bar bar = make_bar(map, area.height(), style);
    const float ticks_left = start + bar.thickness;
    list.push_back(colors(bar, start, area.top, style.scale));
    const auto write = [&](const std::string& text, float middle) {
        const Point at{start + bar.text_left, area.top + middle + 0.36f * em};
        list.push_back(label(text, at, em, style.theme.quiet_text));
    };
    for (const Tick& tick : bar.ticks) {
        if (tick.text.empty()) continue;
        const float y = bar.axis.at(tick.value);
        list.push_back(
            horizontal_line(area.top + y, ticks_left, ticks_left + 0.25f * em, style.line, style.theme.frame));
        write(tick.text, y);
    }
    // labels are centred on their ticks, so none exceeds the panel by more than half a line
    if (bar.none.empty()) return;
    const float top = std::round(area.top + bar.none_top + 0.1f * em);
    list.push_back(
        Box{start, top, start + bar.thickness, top + std::round(0.95f * em), 0, none_color(map, style.theme)});
    for (std::size_t i = 0; i < bar.none.size(); ++i)
        write(bar.none[i], bar.none_top + (0.6f + 1.2f * static_cast<float>(i)) * em);
}

}  // namespace doppel

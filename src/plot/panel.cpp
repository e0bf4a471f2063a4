#include "plot/chart_parts.hpp"
#include "plot/labels.hpp"
#include "render/typeface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace doppel {
namespace {

Axis placed(Axis axis, float from, float to) {
    axis.from = from;
    axis.to = to;
    return axis;
}

/// Dashed lines.
void draw_rules(const Panel& panel, LabelPlacer& placer) {
    const auto& [left, top, right, bottom] = panel.area;
    for (const Rule& rule : panel.plot.rules) {
        const bool level = rule.orientation == Rule::Orientation::horizontal;
        const Axis& axis = level ? panel.axes.y : panel.axes.x;
        if (const double share = axis.share(rule.at); !(share >= 0 && share <= 1)) continue;
        const float at = std::floor(axis.at(rule.at)) + 0.5f;
        const Point from = level ? Point{left, at} : Point{at, bottom}, to = level ? Point{right, at} : Point{at, top};
        const float width = std::max(std::round(1.3f * panel.style.unit), 1.0f);
        const Color color = panel.is_map() ? rgb(0xffffff) : panel.style.theme.quiet_text;
        if (panel.is_map()) draw_line({{from, to}}, width + 2, false, rgb(0x0b0e13).with_alpha(0.75f), panel);
        draw_line({{from, to}}, width, true, color, panel);
        placer.add_line(from, to, LabelPlacer::no_owner - 1);
    }
}

LabelNeeds draw_curves(const Panel& panel, const LabelNeeds& given, LabelPlacer& placer) {
    const auto& curves = panel.plot.curves;
    std::vector<DrawnCurve> all;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        all.push_back(drawn(curves[i], panel.axes.x, panel.y_of(curves[i]), panel.area));
        const std::size_t owner = i % (LabelPlacer::no_owner - 1);
        if (curves[i].background != Background::none) {
            draw_curve(curves[i], all.back(), panel);
            all.back() = {};  // labels may cover it
        }
        for (const auto& line : all.back().lines)
            for (std::size_t k = 1; k < line.size(); ++k) placer.add_line(line[k - 1], line[k], owner);
        const float r = panel.style.marker;
        for (const Point& at : all.back().points)
            for (const float up : {-0.7f * r, 0.7f * r})
                placer.add_line({at.x - r, at.y + up}, {at.x + r, at.y + up}, owner);
        draw_band(curves[i], panel);
    }
    std::array<std::size_t, 2> marks{};  // normal and quiet marks
    for (std::size_t i = 0; i < curves.size(); ++i) marks[curves[i].quiet] += all[i].points.size();
    for (std::size_t i = 0; i < curves.size(); ++i) all[i].marks_in_panel = marks[curves[i].quiet];
    // quiet curves are drawn first, below the others
    for (const bool quiet : {true, false})
        for (std::size_t i = 0; i < curves.size(); ++i)
            if (curves[i].quiet == quiet) draw_curve(curves[i], all[i], panel);
    label_rules(panel, placer);
    return label_curves(all, given, placer, panel);
}

}  // namespace

Gutters gutters(const Plot& plot, const PlotRanges& ranges, float width, float height, const AxisWords& words,
                const PlotStyle& style) {
    const float em = style.tick;
    Gutters made;
    made.title = plot.title.empty() && plot.note.empty() ? 0 : 1.5f * style.heading;
    made.labels = axis_labels_height(plot, width, words, style);
    made.bottom = words.x ? 1.75f * em + (plot.x.label.empty() ? 0 : 1.45f * style.axis) : 0.34f * em;
    const float tall = std::max(height - made.top(style) - made.bottom, 1.0f);
    made.left = 0.34f * em;
    if (words.y) made.left = 0.55f * em + widest(ticks_of(placed(ranges.y, tall, 0), plot.y, false, style), em);
    if (ranges.right)
        made.right = 0.55f * em + widest(ticks_of(placed(*ranges.right, tall, 0), *plot.right, false, style), em);
    if (plot.map && !plot.map->shares_bar) made.right += bar_gutter(*plot.map, tall, style);
    if (!words.x) return made;
    // the first and last label below the axis extend beyond it by half their width
    const float wide = std::max(width - made.left - made.right, 1.0f);
    const auto below = ticks_of(placed(ranges.x, 0, wide), plot.x, true, style);
    const float half = widest(below, em) / 2;
    made.left = std::max(made.left, std::min(half, 0.2f * width));
    made.right = std::max(made.right, std::min(half, 0.2f * width));
    return made;
}

LabelNeeds draw_panel(const Plot& plot, PlotRanges& ranges, const Area& cell, const Gutters& around,
                      const AxisWords& words, const LabelNeeds& given, const PlotStyle& style, PageList& list) {
    Area area{std::round(cell.left + around.left), std::round(cell.top + around.top(style)),
              std::round(cell.right - around.right), std::round(cell.bottom - around.bottom)};
    Area held = cell;
    if (plot.square) {
        // centred in its cell, including labels
        const float side = std::min(area.width(), area.height());
        const float right = std::floor((area.width() - side) / 2), down = std::floor((area.height() - side) / 2);
        held = held.grown(-right, -down);
        area = {area.left + right, area.top + down, area.left + right + side, area.top + down + side};
    }
    ranges.x = placed(ranges.x, area.left, area.right);
    ranges.y = placed(ranges.y, area.bottom, area.top);
    if (area.width() < drawn_side || area.height() < drawn_side) return given;
    if (ranges.right) ranges.right = placed(*ranges.right, area.bottom, area.top);
    if (plot.map) list.push_back(map_cells(plot, ranges.x, ranges.y, area, style.theme));
    if (plot.map && !plot.map->shares_bar) draw_bar(*plot.map, area, area.right, style, list);
    const Panel panel{plot, ranges, area, held, words, style, list};
    draw_axes(panel);
    draw_headings(panel, around.title, around.labels);
    LabelPlacer placer(area);
    draw_rules(panel, placer);
    return draw_curves(panel, given, placer);
}

}  // namespace doppel

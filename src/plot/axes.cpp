#include "plot/axis.hpp"
#include "plot/chart_parts.hpp"
#include "plot/labels.hpp"
#include "render/typeface.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr float label_line = 1.4f;  // em of a label above the panel

/// The colour of a vertical axis: that of its curves if they share one, otherwise that of text.
Color axis_color(const Plot& plot, bool right, const PlotStyle& style) {
    std::optional<Color> color;
    for (const Curve& curve : plot.curves) {
        if (curve.right != right || curve.quiet) continue;
        const Color own = curve_color(curve, style.theme);
        if (color && !(*color == own)) return style.theme.text;
        color = own;
    }
    return plot.right && color ? *color : style.theme.text;
}

/// A text above the panel.
struct Heading {
    std::string text;
    Align align;
    Color color;
};

std::vector<Heading> headings(const Plot& plot, const AxisWords& words, const PlotStyle& style) {
    std::vector<Heading> all;
    if (words.y_name) all.push_back({plot.y.label, Align::left, axis_color(plot, false, style)});
    if (plot.right) all.push_back({plot.right->label, Align::right, axis_color(plot, true, style)});
    if (plot.map && !plot.map->shares_bar) all.push_back({plot.map->label, Align::right, style.theme.text});
    std::erase_if(all, [](const Heading& heading) { return heading.text.empty(); });
    return all;
}

/// Whether all fit on one line, one at the left and one at the right.
bool side_by_side(const std::vector<Heading>& all, float width, const PlotStyle& style) {
    float need = 1.5f * style.axis * static_cast<float>(all.size() - 1);
    for (const Heading& heading : all) need += text_width(heading.text, style.axis);
    return all.size() == 1 || need <= width;
}

}  // namespace

std::vector<Tick> ticks_of(const Axis& axis, const PlotAxis& requested, bool across, const PlotStyle& style) {
    return spaced_ticks(axis, across, style.tick, requested.every);
}

void draw_axes(const Panel& panel) {
    using Edge = AxisStyle::Edge;
    const Plot& plot = panel.plot;
    const Area& area = panel.area;
    const PlotStyle& style = panel.style;
    const Theme& theme = style.theme;
    PageList& list = panel.list;
    const auto draw = [&](const Axis& axis, const PlotAxis& requested, Edge edge, bool has_numbers, Color text) {
        const bool has_grid = !plot.map && edge != Edge::right;
        const AxisStyle own{edge, style.tick, style.line, theme.grid, theme.frame, text, has_grid, has_numbers};
        const auto ticks = ticks_of(axis, requested, edge == Edge::bottom, style);
        for (const auto& item : page_list(axis_items(axis, ticks, area, panel.held, own))) list.push_back(item);
    };
    draw(panel.axes.x, plot.x, Edge::bottom, panel.words.x, theme.quiet_text);
    if (const std::string& text = plot.x.label; panel.words.x && !text.empty()) {
        const float half = text_width(text, style.axis) / 2, baseline = area.bottom + 1.45f * style.tick;
        const float leftmost = panel.held.left + half, rightmost = std::max(leftmost, panel.held.right - half);
        const float middle = std::clamp((area.left + area.right) / 2, leftmost, rightmost);
        list.push_back(label(text, {middle, baseline + 1.5f * style.axis}, style.axis, theme.text, Align::center));
    }
    draw(panel.axes.y, plot.y, Edge::left, panel.words.y, theme.quiet_text);
    if (plot.right) {
        draw(*panel.axes.right, *plot.right, Edge::right, true, axis_color(plot, true, style));
        list.push_back(vertical_line(area.right, area.top, area.bottom, style.line, theme.frame));
    }
    list.push_back(vertical_line(area.left, area.top, area.bottom, style.line, theme.frame));
    list.push_back(horizontal_line(area.bottom, area.left, area.right, style.line, theme.frame));
}

float axis_labels_height(const Plot& plot, float width, const AxisWords& words, const PlotStyle& style) {
    const auto all = headings(plot, words, style);
    if (all.empty()) return 0;
    const float line = label_line * style.axis;
    return side_by_side(all, width, style) ? line : line * static_cast<float>(all.size());
}

void fit_labels(const Plot& plot, float width, const PlotStyle& style, PlotStyle& fitted) {
    const auto fit = [](std::string_view text, float size, Weight weight, float room, float& into) {
        into = std::min(into, fitting_size(text, size, weight, room));
    };
    fit(plot.x.label, style.axis, Weight::regular, width, fitted.axis);
    for (const Heading& heading : headings(plot, {}, style))
        fit(heading.text, style.axis, Weight::regular, width, fitted.axis);
    // shrinks the title a little, so that the note fits beside it
    constexpr float minimum = 0.85f;
    const float beside = plot.note.empty() ? 0 : 1.5f * style.heading + text_width(plot.note, style.tick);
    const bool has_note =
        fitting_size(plot.title, style.heading, Weight::bold, width - beside) >= minimum * style.heading;
    fit(plot.title, style.heading, Weight::bold, width - (has_note ? beside : 0), fitted.heading);
    fitted.has_notes = fitted.has_notes && has_note;
}

void draw_headings(const Panel& panel, float title, float labels) {
    const auto& [plot, axes, area, held, words, style, list] = panel;
    // above the panel, and above the panel's own axis labels
    const bool own_words = plot.right || (plot.map && !plot.map->shares_bar);
    const float left = words.y ? held.left : area.left;
    const float right = own_words ? held.right : area.right;
    const auto write = [&, &into = list](const Heading& heading, float baseline, float em, Weight weight) {
        const float x = heading.align == Align::left ? left : right;
        into.push_back(Label{heading.text, {x, baseline}, em, heading.align, weight, heading.color});
    };
    const float first = held.top + 0.95f * style.heading;
    if (!plot.title.empty()) write({plot.title, Align::left, style.theme.text}, first, style.heading, Weight::bold);
    if (style.has_notes && !plot.note.empty())
        write({plot.note, Align::right, style.theme.quiet_text}, first, style.tick, Weight::regular);
    const auto all = headings(plot, words, style);
    const bool together = !all.empty() && side_by_side(all, held.width(), style);
    float baseline = held.top + title + labels - 0.35f * style.axis;
    // upwards from the line next to the panel
    for (std::size_t i = all.size(); i-- > 0;) {
        write(all[i], baseline, style.axis, Weight::regular);
        if (!together) baseline -= label_line * style.axis;
    }
}

}  // namespace doppel

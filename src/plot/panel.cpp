#include "plot/panel.hpp"

#include "plot/labels.hpp"
#include "render/typeface.hpp"

#include <array>

namespace doppel {
namespace {

Axis placed(const Axis& axis, float from, float to) {
    return {axis.low, axis.high, from, to, axis.logarithmic};
}

constexpr float label_line = 1.4f, title_line = 1.2f;  // em of a label above the panel, and of a line of its title

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

/// Grid, axes, ticks with labels, and the label of the x axis.
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
        const auto ticks = spaced_ticks(axis, edge == Edge::bottom, style.tick, requested.every, requested.ticks);
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

/// Height of the labels above a panel of this width, px: one line if all fit side by side, otherwise one each.
float axis_labels_height(const Plot& plot, float width, const AxisWords& words, const PlotStyle& style) {
    const auto all = headings(plot, words, style);
    if (all.empty()) return 0;
    const float line = label_line * style.axis;
    return side_by_side(all, width, style) ? line : line * static_cast<float>(all.size());
}

std::vector<std::string> title_lines(const Plot& plot, float width, const PlotStyle& style) {
    return wrapped(plot.title, style.heading, Weight::bold, style.on_paper ? width : INFINITY);
}

/// The panel's title in the uppermost `title` px. The labels of the vertical axes and of the map's bar are in the
/// `labels` px below.
void draw_headings(const Panel& panel, float title, float labels) {
    const auto& [plot, axes, area, held, words, style, list] = panel;
    // above the panel, and above the panel's own axis labels
    const bool own_words = plot.right || (plot.map && !plot.map->shares_bar);
    const float left = words.y ? held.left : area.left;
    const float right = own_words ? held.right : area.right;
    const auto write = [&, &into = list, &cell = held](const Heading& heading, float baseline, float em,
                                                       Weight weight) {
        // further to the left if it would end beyond the panel
        const float first = std::max(cell.left, cell.right - text_width(heading.text, em, weight));
        const float x = heading.align == Align::left ? std::min(left, first) : right;
        into.push_back(Label{heading.text, {x, baseline}, em, heading.align, weight, heading.color});
    };
    float baseline = held.top + 0.95f * style.heading;
    if (style.notes == PlotStyle::Notes::beside && !plot.note.empty())
        write({plot.note, Align::right, style.theme.quiet_text}, baseline, style.tick, Weight::regular);
    for (const auto& line : title_lines(plot, held.width(), style)) {
        if (!line.empty()) write({line, Align::left, style.theme.text}, baseline, style.heading, Weight::bold);
        baseline += title_line * style.heading;
    }
    if (style.notes == PlotStyle::Notes::below && !plot.note.empty())
        write({plot.note, Align::left, style.theme.quiet_text}, baseline, style.tick, Weight::regular);
    const auto all = headings(plot, words, style);
    const bool together = !all.empty() && side_by_side(all, held.width(), style);
    baseline = held.top + title + labels - 0.35f * style.axis;
    // upwards from the line next to the panel
    for (std::size_t i = all.size(); i-- > 0;) {
        write(all[i], baseline, style.axis, Weight::regular);
        if (!together) baseline -= label_line * style.axis;
    }
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

void fit_labels(const Plot& plot, float width, const PlotStyle& style, PlotStyle& fitted) {
    const auto fit = [](std::string_view text, float size, Weight weight, float room, float& into) {
        into = std::min(into, fitting_size(text, size, weight, room));
    };
    fit(plot.x.label, style.axis, Weight::regular, width, fitted.axis);
    for (const Heading& heading : headings(plot, {}, style))
        fit(heading.text, style.axis, Weight::regular, width, fitted.axis);
    // shrinks the title a little, so that the note fits beside it
    constexpr float minimum = 0.85f;
    const float note = text_width(plot.note, style.tick), beside = plot.note.empty() ? 0 : 1.5f * style.heading + note;
    const bool has_note =
        fitting_size(plot.title, style.heading, Weight::bold, width - beside) >= minimum * style.heading;
    fit(plot.title, style.heading, Weight::bold, width - (has_note ? beside : 0), fitted.heading);
    fitted.heading = std::max(fitted.heading, std::min(style.heading, style.least));
    if (!has_note)
        fitted.notes = std::max(fitted.notes, note > width ? PlotStyle::Notes::none : PlotStyle::Notes::below);
}

float further_lines(const Plot& plot, float width, const PlotStyle& style) {
    const auto lines = static_cast<float>(title_lines(plot, width, style).size()) - 1;
    return title_line * style.heading * lines +
           (style.notes == PlotStyle::Notes::below && !plot.note.empty() ? label_line * style.tick : 0);
}

Gutters gutters(const Plot& plot, const PlotRanges& ranges, float width, float height, const AxisWords& words,
                const PlotStyle& style) {
    const float em = style.tick;
    Gutters made;
    made.title = plot.title.empty() && plot.note.empty() ? 0 : 1.5f * style.heading;
    made.labels = axis_labels_height(plot, width, words, style);
    made.bottom = words.x ? 1.75f * em + (plot.x.label.empty() ? 0 : 1.45f * style.axis) : 0.34f * em;
    const float tall = std::max(height - made.top(style) - made.bottom, 1.0f);
    const auto beside = [&](const Axis& axis, const PlotAxis& requested) {
        const auto ticks = spaced_ticks(placed(axis, tall, 0), false, em, requested.every, requested.ticks);
        return 0.55f * em + widest(ticks, em);
    };
    made.left = words.y ? beside(ranges.y, plot.y) : 0.34f * em;
    if (ranges.right) made.right = beside(*ranges.right, *plot.right);
    if (plot.map && !plot.map->shares_bar) made.right += bar_gutter(*plot.map, tall, style);
    if (!words.x) return made;
    // the first and last label below the axis extend beyond it by half their width
    const float wide = std::max(width - made.left - made.right, 1.0f);
    const auto below = spaced_ticks(placed(ranges.x, 0, wide), true, em, plot.x.every, plot.x.ticks);
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

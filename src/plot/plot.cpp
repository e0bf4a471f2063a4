#include "plot/plot.hpp"

#include "plot/labels.hpp"
#include "plot/panel.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

/// The extent of the values on one axis.
class Extent {
public:
    explicit Extent(bool logarithmic) : logarithmic_(logarithmic) {}

    bool can_show(double value) const { return std::isfinite(value) && (value > 0 || !logarithmic_); }
    void add(double value) {
        if (!can_show(value)) return;
        low_ = std::min(low_, value);
        high_ = std::max(high_, value);
    }

    /// The range with a `margin` at either side, except for ends that `axis` sets.
    Axis range(const PlotAxis& axis, double margin) const {
        double low = low_, high = high_;
        if (!(low <= high)) low = logarithmic_ ? 1 : 0, high = logarithmic_ ? 10 : 1;
        // if the given end is on the wrong side of the values, the other is chosen beyond it
        if (axis.low && !axis.high)
            high = high > *axis.low ? high : beyond(*axis.low, 1), low = std::min(*axis.low, low);
        if (axis.high && !axis.low)
            low = low < *axis.high ? low : beyond(*axis.high, -1), high = std::max(*axis.high, high);
        if (low == high) low = beyond(low, -1), high = beyond(high, 1);
        if (logarithmic_) {
            const double part = std::pow(10.0, margin * (std::log10(high) - std::log10(low)));
            low = std::max(low / part, std::numeric_limits<double>::min());
            high = std::min(high * part, largest);
        } else {
            const double part = 2 * margin * (high / 2 - low / 2);
            low = low >= 0 && low < part ? 0 : std::max(low - part, -largest);
            high = std::min(high + part, largest);
        }
        Axis made{.low = axis.low.value_or(low), .high = axis.high.value_or(high), .logarithmic = logarithmic_};
        if (made.low == made.high) made.low = beyond(made.low, -1), made.high = beyond(made.high, 1);
        return made;
    }

private:
    /// Something a little larger than `limit`, for `way` −1 smaller.
    double beyond(double limit, int way) const {
        const double linear = limit == 0 ? way : limit + way * 0.1 * std::abs(limit);
        return std::clamp(!logarithmic_ ? linear : way > 0 ? limit * 3 : limit / 3, -largest, largest);
    }

    bool logarithmic_;
    double low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
};

/// The requested ranges. Missing ends are fitted to the contents with a small margin (none around a map, or below
/// zero).
PlotRanges fitted_ranges(const Plot& plot) {
    Extent x(plot.x.logarithmic), y(plot.y.logarithmic), right(plot.right && plot.right->logarithmic);
    for (const Curve& curve : plot.curves) {
        Extent& values = curve.right && plot.right ? right : y;
        for (std::size_t i = 0; i < curve.x.size(); ++i) {
            if (!x.can_show(curve.x[i]) || !values.can_show(curve.y[i])) continue;
            x.add(curve.x[i]);
            values.add(curve.y[i]);
            if (curve.uncertainty.empty()) continue;
            values.add(curve.y[i] - std::abs(curve.uncertainty[i]));
            values.add(curve.y[i] + std::abs(curve.uncertainty[i]));
        }
    }
    for (const Rule& rule : plot.rules) (rule.orientation == Rule::Orientation::vertical ? x : y).add(rule.at);
    PlotRanges ranges{x.range(plot.x, plot.map ? 0 : 0.015), y.range(plot.y, plot.map ? 0 : 0.05), {}};
    if (plot.right) ranges.right = right.range(*plot.right, 0.05);
    return ranges;
}

struct PanelGrid {
    int columns, rows;
};

/// The map whose colour bar all panels share, or null.
const HeatMap* shared_map(const Figure& figure) {
    const auto found =
        std::ranges::find_if(figure.panels, [](const Plot& plot) { return plot.map && plot.map->shares_bar; });
    return found == figure.panels.end() ? nullptr : &*found->map;
}

/// If panels share axes, only the leftmost and lowest ones show the texts of these.
AxisWords axis_words(const Figure& figure, std::size_t panel, std::size_t columns) {
    if (!figure.shares_axes) return {};
    const auto& all = figure.panels;
    const Plot& plot = all[panel];
    AxisWords words;
    const auto ends = [&](std::size_t i) { return i + columns >= all.size() || all[i + columns].x != all[i].x; };
    words.x = ends(panel);
    // beside the words of another axis, each panel has its own
    for (std::size_t i = panel - panel % columns; i < std::min(panel - panel % columns + columns, all.size()); ++i)
        words.x = words.x || (ends(i) && all[i].x != plot.x);
    words.y = panel % columns == 0 || all[panel - 1].y != plot.y;
    words.y_name = words.y && (panel < columns || all[panel - columns].y != plot.y);
    return words;
}

/// Gives axes with the same label the union of their ranges.
void share_ranges(const std::vector<Plot>& panels, std::vector<PlotRanges>& ranges) {
    for (const auto& [axis, range] : {std::pair(&Plot::x, &PlotRanges::x), {&Plot::y, &PlotRanges::y}})
        for (const auto& one : panels) {
            std::vector<Axis*> matching;
            for (std::size_t i = 0; i < panels.size(); ++i)
                if (panels[i].*axis == one.*axis) matching.push_back(&(ranges[i].*range));
            Axis all = *matching.front();
            for (const Axis* each : matching)
                if (all.low < all.high)
                    all.low = std::min(all.low, each->low), all.high = std::max(all.high, each->high);
            for (Axis* each : matching) *each = all;
        }
}

/// The larger of each side.
Gutters united(const Gutters& a, const Gutters& b) {
    return {std::max(a.left, b.left), std::max(a.right, b.right), std::max(a.title, b.title),
            std::max(a.labels, b.labels), std::max(a.bottom, b.bottom)};
}

/// The cells of all panels and the space for texts around the panels.
struct Cells {
    std::vector<Gutters> columns, rows;
    float width, height;  // size of a panel without its texts, px

    Gutters around(std::size_t column, std::size_t row) const {
        return {columns[column].left, columns[column].right, rows[row].title, rows[row].labels, rows[row].bottom};
    }
};

/// Whole pixels, so that all panels have the same size. If they share axes, each column and row takes what its own
/// texts need; otherwise all take as much as the largest.
Cells cells_of(const std::vector<Gutters>& own, const PanelGrid& grid, float width, float height, bool shares_axes,
               const PlotStyle& style) {
    const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
    Cells cells{std::vector<Gutters>(columns), std::vector<Gutters>(rows), 0, 0};
    Gutters largest;
    for (const Gutters& each : own) largest = united(largest, each);
    if (!shares_axes) {
        std::ranges::fill(cells.columns, largest);
        std::ranges::fill(cells.rows, largest);
        cells.width = std::floor(width / static_cast<float>(columns)) - largest.left - largest.right;
        cells.height = std::floor(height / static_cast<float>(rows)) - largest.top(style) - largest.bottom;
        return cells;
    }
    for (std::size_t i = 0; i < own.size(); ++i)
        for (Gutters* of : {&cells.columns[i % columns], &cells.rows[i / columns]}) *of = united(*of, own[i]);
    for (Gutters& of : cells.columns) {
        of.left = std::ceil(of.left), of.right = std::ceil(of.right);
        width -= of.left + of.right;
    }
    for (Gutters& of : cells.rows) {
        of.bottom += std::ceil(of.top(style) + of.bottom) - of.top(style) - of.bottom;
        height -= of.top(style) + of.bottom;
    }
    cells.width = std::floor(width / static_cast<float>(columns));
    cells.height = std::floor(height / static_cast<float>(rows));
    return cells;
}

/// Space between panels, px.
float gap_across(const PlotStyle& style) {
    return std::round(1.9f * style.tick);
}

/// The figure's number of columns, or the one that makes the panels largest; fewer if panels would be too narrow for
/// their texts.
PanelGrid grid_of(const Figure& figure, const Area& body, const PlotStyle& style) {
    constexpr float narrowest = 9;  // em of ticks, with the texts
    const int panels = static_cast<int>(figure.panels.size());
    const HeatMap* map = shared_map(figure);
    const float bar = map ? bar_gutter(*map, body.height(), style) : 0, gap = gap_across(style);
    const auto grid = [&](int columns) { return PanelGrid{columns, (panels + columns - 1) / columns}; };
    const auto is_narrow = [&](int columns) {
        const auto all = static_cast<float>(columns);
        return columns > 1 && body.width() - bar + gap < all * (narrowest * style.tick + gap);
    };
    if (const int own = std::min(figure.columns, panels); own > 0 && !is_narrow(own)) return grid(own);
    const float shape = figure.panels.front().square ? 1.0f : 1.6f;  // preferred ratio of width to height
    PanelGrid best = grid(1);
    float maximum = 0;
    for (int columns = 1; columns <= panels && !is_narrow(columns); ++columns) {
        const PanelGrid tried = grid(columns);
        const float room = std::min(body.width() / static_cast<float>(columns),
                                    shape * (body.height() / static_cast<float>(tried.rows)));
        if (room > 1.001f * maximum) maximum = room, best = tried;
    }
    return best;
}

/// Draws all panels of the figure, and the colour bar that they share, and sets the axes of each, with their pixels.
/// Returns whether the notes of all panels are drawn.
bool draw_panels(const Figure& figure, Area body, const PlotStyle& style, Page& page) {
    PageList& list = page.items;
    std::vector<PlotRanges>& ranges = page.panels;
    const PanelGrid grid = grid_of(figure, body, style);
    if (const HeatMap* map = shared_map(figure)) {
        const float gutter = bar_gutter(*map, body.height(), style);
        draw_bar(*map, body, body.right - gutter, style, list);
        body.right -= gutter;
    }
    const auto columns = static_cast<std::size_t>(grid.columns);
    const float across = gap_across(style), down = std::round(1.3f * style.tick);
    const float width = body.width() - across * static_cast<float>(grid.columns - 1);
    const float height = body.height() - down * static_cast<float>(grid.rows - 1);
    ranges.clear();
    for (const auto& panel : figure.panels) ranges.push_back(fitted_ranges(panel));
    if (figure.shares_axes) share_ranges(figure.panels, ranges);
    // drawn again if the labels need more space than they were given
    const std::size_t before = list.size();
    std::vector<float> titles(figure.panels.size());  // height of further lines and of notes below them
    for (LabelNeeds given;;) {
        std::vector<Gutters> own;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            own.push_back(gutters(figure.panels[i], ranges[i], std::floor(width / static_cast<float>(grid.columns)),
                                  std::floor(height / static_cast<float>(grid.rows)), axis_words(figure, i, columns),
                                  style));
            own.back().right += given.legend;
            own.back().title += titles[i];
        }
        const Cells cells = cells_of(own, grid, width, height, figure.shares_axes, style);
        PlotStyle fitted = style;
        const auto width_of = [&](std::size_t i) {
            const Gutters around = cells.around(i % columns, i / columns);
            const float wide = figure.panels[i].square ? std::min(cells.width, cells.height) : cells.width;
            return around.left + wide + around.right;
        };
        for (std::size_t i = 0; i < figure.panels.size(); ++i) fit_labels(figure.panels[i], width_of(i), style, fitted);
        constexpr float lowest = 5;  // em of ticks: a panel above which there is space for notes
        if (std::ranges::max(titles) == 0 && cells.height < lowest * style.tick &&
            fitted.notes == PlotStyle::Notes::below)
            fitted.notes = PlotStyle::Notes::none;
        LabelNeeds needs = given;
        bool grown = false;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            const float height = further_lines(figure.panels[i], width_of(i), fitted);
            grown = grown || height > titles[i];
            titles[i] = std::max(titles[i], height);
        }
        float left = body.left, top = body.top;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            const Gutters around = cells.around(i % columns, i / columns);
            const float right = left + around.left + cells.width + around.right;
            const float bottom = top + around.top(style) + cells.height + around.bottom;
            const auto own_needs = draw_panel(figure.panels[i], ranges[i], {left, top, right, bottom}, around,
                                              axis_words(figure, i, columns), given, fitted, list);
            needs.small = needs.small || own_needs.small;
            needs.legend = std::max(needs.legend, own_needs.legend);
            left = right + across;
            if ((i + 1) % columns == 0) left = body.left, top = bottom + down;
        }
        if (needs == given && !grown) return fitted.notes != PlotStyle::Notes::none;
        given = needs;
        list.resize(before);
    }
}

/// One line of at most `width` px if possible. It is shrunk, on paper to the size of labels, otherwise to three quarters
/// but not below 9 px, then broken.
TextBlock fitted_block(std::string_view text, float size, Weight weight, Color color, float width,
                       const PlotStyle& style) {
    if (text.empty()) return {{}, size, weight, color};
    const float minimum = style.on_paper ? style.text : std::max(0.75f * size, 9.0f);
    const float shrunk = std::max(fitting_size(text, size, weight, width), std::min(size, minimum));
    return {evenly_wrapped(text, shrunk, weight, width), shrunk, weight, color};
}

/// The texts above and below the panels, and the area between.
struct Layout {
    TextBlock title, subtitle;
    std::vector<TextBlock> captions;
    Area body;
    float captions_top = 0;
    std::vector<std::string_view> left_out;  // for lack of space
};

/// Whether the contents of the body are large enough to read.
bool legible(const Figure& figure, const Area& body, const Area& sheet, const PlotStyle& style) {
    if (figure.panels.empty()) return body.height() >= 0;
    const auto rows = static_cast<float>(grid_of(figure, body, style).rows);
    return body.height() >= std::max(0.5f * sheet.height(), (style.on_paper ? 9.5f : 12.5f) * style.tick * rows);
}

/// Whether the panels have space besides their labels and ticks.
bool has_room(const Figure& figure, const Area& body, const PlotStyle& style) {
    if (figure.panels.empty()) return true;
    const auto [columns, rows] = grid_of(figure, body, style);
    return body.height() >= (style.on_paper || figure.shares_axes ? 7 : 13) * style.tick * static_cast<float>(rows) &&
           body.width() >= 9 * style.tick * static_cast<float>(columns);
}

/// The layout with all text if that leaves the panels enough space; otherwise without captions, or also without
/// subtitle.
Layout figure_layout(const Figure& figure, const Area& sheet, const PlotStyle& style) {
    Layout page;
    const Theme& theme = style.theme;
    const float width = sheet.width();
    for (const auto& [subtitle, captions] : {std::pair{true, true}, {true, false}, {false, false}}) {
        page = {};
        page.title = fitted_block(figure.title, style.title, Weight::bold, theme.text, width, style);
        page.subtitle = fitted_block(subtitle ? figure.subtitle : "", style.subtitle, Weight::regular, theme.quiet_text,
                                     width, style);
        page.body = sheet;
        page.body.top += page.title.height() + page.subtitle.height();
        if (page.body.top > sheet.top) page.body.top += 0.75f * style.subtitle;
        float height = 0;
        for (const std::string& caption : figure.captions) {
            if (!captions) break;
            page.captions.push_back({evenly_wrapped(caption, style.caption, Weight::regular, width), style.caption,
                                     Weight::regular, theme.quiet_text});
            height += page.captions.back().height();
        }
        page.captions_top = sheet.bottom - height;
        if (height > 0) page.body.bottom = page.captions_top - 0.9f * style.caption;
        if (legible(figure, page.body, sheet, style)) break;
    }
    if (page.subtitle.lines.empty() && !figure.subtitle.empty()) page.left_out.emplace_back("the subtitle");
    if (page.captions.empty() && !figure.captions.empty()) page.left_out.emplace_back("the captions");
    return page;
}

}  // namespace

MapScale::MapScale(const HeatMap& map) {
    Extent values(map.logarithmic);
    if (!map.low || !map.high)
        for (const float value : map.values) values.add(static_cast<double>(value));
    axis = values.range({.low = map.low, .high = map.high, .logarithmic = map.logarithmic}, 0);
    if (map.threshold) step = axis.share(*map.threshold);
}

Color MapScale::color(double share) const {
    constexpr double below = 0.3, above = 0.93;
    return map_color(!step ? share : share > *step ? above : below);
}

bool have_sides(const std::vector<PlotRanges>& panels, float width, float height) {
    return std::ranges::all_of(panels, [&](const PlotRanges& panel) {
        return panel.x.to - panel.x.from >= width && panel.y.from - panel.y.to >= height;
    });
}

Page compose(const Figure& figure, Size size, const Theme& theme, float scale, std::optional<float> unit) {
    Page made{.size = size, .scale = scale, .items = {}};
    for (;; made.scale *= 0.8f) {
        const float width = static_cast<float>(size.width) / made.scale;
        const float height = static_cast<float>(size.height) / made.scale;
        // text smaller than that of an 800 × 450 picture cannot be read
        const float by_size = std::max(std::min(width / 1600, height / 900), 0.5f);
        const PlotStyle style{
            .theme = theme, .unit = unit.value_or(by_size), .scale = made.scale, .on_paper = unit.has_value()};
        // a page has its own margins
        const float across = std::round((style.on_paper ? 8 : 34) * style.unit);
        const float down = std::round((style.on_paper ? 8 : 28) * style.unit);
        const Area sheet{across, down, width - across, height - down};
        Layout page = figure_layout(figure, sheet, style);
        // with many panels in a small picture, shrinks the text to leave space for the panels
        constexpr float min_scale = 0.1f;
        if (!has_room(figure, page.body, style) && made.scale > min_scale) continue;

        made.items = {Box{0, 0, width, height, 0, theme.background}};
        page.title.draw({sheet.left, sheet.top}, made.items);
        page.subtitle.draw({sheet.left, sheet.top + page.title.height()}, made.items);
        if (!figure.panels.empty() && !draw_panels(figure, page.body, style, made))
            page.left_out.emplace_back("the notes of panels");
        if (!have_sides(made.panels, drawn_side, drawn_side) && made.scale > min_scale) continue;
        float top = page.captions_top;
        for (const TextBlock& caption : page.captions) {
            caption.draw({sheet.left, top}, made.items);
            top += caption.height();
        }
        if (!page.left_out.empty())
            made.notes.push_back(fmt::format("there is no space for {}", fmt::join(page.left_out, " and ")));
        float least = style.text;
        for (const PageItem& item : made.items)
            if (const auto* text = std::get_if<Label>(&item)) least = std::min(least, text->size);
        if (const float part = made.scale / scale * least / style.text; unit && part < 0.99f)
            made.notes.push_back(fmt::format("text is reduced to {:.2g} times its size for lack of space", part));
        return made;
    }
}

}  // namespace doppel

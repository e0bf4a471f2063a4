#include "plot/chart_parts.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The map whose colour bar is shared by all panels; null if each has its own.
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
    words.x = panel + columns >= all.size() || all[panel + columns].x != plot.x;
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

}  // namespace

PanelGrid grid_of(const Figure& figure, const Area& body) {
    const int panels = static_cast<int>(figure.panels.size());
    const auto grid = [&](int columns) { return PanelGrid{columns, (panels + columns - 1) / columns}; };
    if (figure.columns > 0) return grid(std::min(figure.columns, panels));
    const float shape = figure.panels.front().square ? 1.0f : 1.6f;  // preferred ratio of width to height
    PanelGrid best = grid(1);
    float maximum = 0;
    for (int columns = 1; columns <= panels; ++columns) {
        const PanelGrid tried = grid(columns);
        const float room = std::min(body.width() / static_cast<float>(columns),
                                    shape * (body.height() / static_cast<float>(tried.rows)));
        if (room > 1.001f * maximum) maximum = room, best = tried;
    }
    return best;
}

std::vector<PlotRanges> draw_panels(const Figure& figure, Area body, const PlotStyle& style, PageList& list) {
    const PanelGrid grid = grid_of(figure, body);
    if (const HeatMap* map = shared_map(figure)) {
        const float gutter = bar_gutter(*map, body.height(), style);
        draw_bar(*map, body, body.right - gutter, style, list);
        body.right -= gutter;
    }
    const auto columns = static_cast<std::size_t>(grid.columns);
    const float across = std::round(1.9f * style.tick), down = std::round(1.3f * style.tick);
    const float width = body.width() - across * static_cast<float>(grid.columns - 1);
    const float height = body.height() - down * static_cast<float>(grid.rows - 1);
    std::vector<PlotRanges> ranges;
    for (const auto& panel : figure.panels) ranges.push_back(fitted_ranges(panel));
    if (figure.shares_axes) share_ranges(figure.panels, ranges);
    // drawn again if the labels need more space than they were given
    const std::size_t before = list.size();
    for (LabelNeeds given;;) {
        std::vector<Gutters> own;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            own.push_back(gutters(figure.panels[i], ranges[i], std::floor(width / static_cast<float>(grid.columns)),
                                  std::floor(height / static_cast<float>(grid.rows)), axis_words(figure, i, columns),
                                  style));
            own.back().right += given.legend;
        }
        const Cells cells = cells_of(own, grid, width, height, figure.shares_axes, style);
        PlotStyle fitted = style;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            const auto& panel = figure.panels[i];
            const Gutters around = cells.around(i % columns, i / columns);
            const float wide = panel.square ? std::min(cells.width, cells.height) : cells.width;
            fit_labels(panel, around.left + wide + around.right, style, fitted);
        }
        LabelNeeds needs = given;
        float left = body.left, top = body.top;
        for (std::size_t i = 0; i < figure.panels.size(); ++i) {
            const Gutters around = cells.around(i % columns, i / columns);
            const float right = left + around.left + cells.width + around.right;
            const float bottom = top + around.top(style) + cells.height + around.bottom;
            const auto own_needs = draw_panel(figure.panels[i], ranges[i], {left, top, right, bottom}, around,
                                              axis_words(figure, i, columns), given, fitted, list);
            needs = {needs.small || own_needs.small, std::max(needs.legend, own_needs.legend)};
            left = right + across;
            if ((i + 1) % columns == 0) left = body.left, top = bottom + down;
        }
        if (needs == given) return ranges;
        given = needs;
        list.resize(before);
    }
}

}  // namespace doppel

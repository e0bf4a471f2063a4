#pragma once

#include "image/color.hpp"
#include "plot/axis.hpp"
#include "plot/plot.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// What all parts of a figure share: colours, sizes of text (px an em) and of lines (px).
struct PlotStyle {
    const Theme& theme;
    float unit;             // of a picture of 1600 × 900, px
    float scale;            // pixels that one px becomes in the end: what images are drawn for
    bool on_paper = false;  // small, with text of the size that was asked for: the title is little larger
    bool has_notes = true;  // beside the titles of panels, where all have room

    float title = (on_paper ? 26 : 37) * unit, subtitle = 21 * unit, heading = 24 * unit;
    float axis = 20 * unit, tick = 18.5f * unit, text = 20 * unit, caption = 18 * unit;
    float hairline = unit > 0.9f ? unit : 1, line = std::max(1.0f, std::round(hairline));  // line: of whole pixels
    float curve = unit > 0.47f ? 3.2f * unit : 1.5f, thin = unit > 0.5f ? 2 * unit : 1;
    float marker = unit > 0.4f ? 5.2f * unit : 2.1f;  // its radius
};

/// What the labels of a panel's curves take, which all panels of a figure then have alike.
struct LabelNeeds {
    bool small = false;  // labels smaller, and on the curves
    float legend = 0;    // px on the right of the panel, for names that have no place in it

    friend bool operator==(const LabelNeeds&, const LabelNeeds&) = default;
};

/// The ranges of a panel's axes.
struct PlotRanges {
    Axis x, y;
    std::optional<Axis> right;
};

/// What was asked for; the rest holds all that is drawn, with a little margin (none around a map, none below a zero).
PlotRanges fitted_ranges(const Plot& plot);

/// Throws bad_input where a figure cannot be drawn: series of unequal length, a logarithm of nothing, …
void check(const Figure& figure);

/// Ticks with labels beside a vertical axis, and below a horizontal one.
std::vector<Tick> y_ticks(const Axis& axis, const PlotAxis& asked, const PlotStyle& style);
std::vector<Tick> x_ticks(const Axis& axis, const PlotAxis& asked, const PlotStyle& style);

/// Of which axes a panel has the words: numbers at the ticks of either, the name of the vertical one above it.
struct AxisWords {
    bool x = true, y = true, y_name = true;
};

/// The grid, the axes, their ticks with labels, and the x axis's label. No text leaves `held`; `right` may be null.
void draw_axes(const Plot& plot, const Axis& x, const Axis& y, const Axis* right, const Area& area, const Area& held,
               const AxisWords& words, const PlotStyle& style, PageList& list);

/// px that the labels above a panel `width` px wide take: one line if all fit side by side, else one each.
float axis_labels_height(const Plot& plot, float width, const AxisWords& words, const PlotStyle& style);

/// Makes the sizes of labels and titles in `fitted`, which begins as `style`, so small that those of the panel, `width` px
/// wide with its labels, fit.
void fit_labels(const Plot& plot, float width, const PlotStyle& style, PlotStyle& fitted);

/// The panel's title in the uppermost `title` px of `held`; in the `labels` px below, the labels of the vertical axes
/// and of the map's bar.
void draw_headings(const Plot& plot, const Area& area, const Area& held, float title, float labels,
                   const AxisWords& words, const PlotStyle& style, PageList& list);

/// The map's cells as seen through the axes.
CellImage map_cells(const HeatMap& map, const Axis& x, const Axis& y, const Area& area, const Theme& theme);

/// px that the colour bar of a map and its labels take on the right of a panel `height` px high; of a bar that maps share
/// with its label above it.
float bar_gutter(const HeatMap& map, float height, const PlotStyle& style);

/// The bar beside `area`, from `left` on: colours with ticks, and below them what stands for no value.
void draw_bar(const HeatMap& map, Area area, float left, const PlotStyle& style, PageList& list);

/// The colour of what has no value.
Color none_color(const HeatMap& map, const Theme& theme);

/// px around a panel's area for its labels.
struct Gutters {
    float left = 0, right = 0, title = 0, labels = 0, bottom = 0;

    float top(const PlotStyle& style) const { return title + labels + 0.75f * style.tick; }
};

/// Of a panel alone in a cell of this size; panels beside each other share the largest.
Gutters gutters(const Plot& plot, const PlotRanges& ranges, float width, float height, const AxisWords& words,
                const PlotStyle& style);

/// The larger of each.
Gutters united(const Gutters& a, const Gutters& b);

/// The panel in its cell, of which `given` is for the labels of its curves; and what these would need in all. Nothing where
/// the labels leave it no room.
LabelNeeds draw_panel(const Plot& plot, const PlotRanges& ranges, const Area& cell, const Gutters& around,
                      const AxisWords& words, const LabelNeeds& given, const PlotStyle& style, PageList& list);

/// Of panels.
struct PanelGrid {
    int columns, rows;
};

/// The figure's columns, or those that give the panels the most room.
PanelGrid grid_of(const Figure& figure, const Area& body);

/// All panels of the figure, and the bar that they share.
void draw_panels(const Figure& figure, Area body, const PlotStyle& style, PageList& list);

/// A curve in pixels, cut to its panel.
struct DrawnCurve {
    std::vector<std::vector<Point>> lines;  // pieces
    std::vector<Point> points;              // where a mark is due
    std::size_t marks_in_panel = 0;         // quiet or not, as its own; the more, the smaller they are drawn
};

/// Of many points in half a column of pixels the first, the last, the lowest and the highest stay: no pixel tells the
/// difference.
DrawnCurve drawn(const Curve& curve, const Axis& x, const Axis& y, const Area& area);

/// In what colour a curve is drawn; over a map (dark to bright) bright, with a dark edge.
Color curve_color(const Curve& curve, const PlotStyle& style, bool over_map);

/// The band of its uncertainty, if it has one.
void draw_band(const Curve& curve, const Axis& x, const Axis& y, const Area& area, const PlotStyle& style,
               PageList& list);

/// Lines and marks.
void draw_curve(const Curve& curve, const DrawnCurve& drawn, const Area& area, const PlotStyle& style, bool over_map,
                PageList& list);

/// From one place to another, with gaps if it is dashed, as all curves are.
void draw_line(const std::vector<std::vector<Point>>& lines, float width, bool dashed, Color color,
               const PlotStyle& style, PageList& list);

/// Discs around many points as an image for the pixels that `scale` makes of each px: cheaper than paths. Discs of the
/// given opacity add up where they overlap, opaque ones do not; they are cut off at the edges of `area`.
Image scatter_image(const std::vector<Point>& points, float radius, Color color, float opacity, const Area& area,
                    float scale);

}  // namespace doppel

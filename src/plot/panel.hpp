#pragma once

#include "image/color.hpp"
#include "plot/axis.hpp"
#include "plot/plot.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// The style shared by all parts of a figure: colours, text sizes (px per em) and line widths (px).
struct PlotStyle {
    const Theme& theme;
    float unit;             // px of this page to one of a 1600 × 900 picture
    float scale;            // final pixels per px, for drawing images
    bool on_paper = false;  // for a page with the requested text size: the title is only slightly larger than the text
    enum class Notes { beside, below, none } notes = Notes::beside;  // place of all notes: by the titles of panels

    float title = (on_paper ? 26 : 37) * unit, subtitle = 21 * unit, heading = 24 * unit;
    float axis = 20 * unit, tick = (on_paper ? 20 : 18.5f) * unit, text = 20 * unit,
          caption = (on_paper ? 20 : 18) * unit;
    float least = on_paper ? text : 0;  // on paper no text is smaller if it can be broken or left out
    float hairline = unit > 0.9f ? unit : 1, line = std::max(1.0f, std::round(hairline));  // line: of whole pixels
    float curve = unit > 0.47f ? 3.2f * unit : 1.5f, thin = unit > 0.5f ? 2 * unit : 1;
    float marker = unit > 0.4f ? 5.2f * unit : 2.1f;  // radius
};

/// The space that the labels of curves need; it is the same for all panels of a figure.
struct LabelNeeds {
    bool small = false;  // smaller labels, on the curves
    float legend = 0;    // width at the right of the panel for all names, where some do not fit inside, px

    friend bool operator==(const LabelNeeds&, const LabelNeeds&) = default;
};

/// The axes whose texts a panel shows: the numbers at the ticks, and the label of the vertical axis above the panel.
struct AxisWords {
    bool x = true, y = true, y_name = true;
};

/// A panel that is being drawn.
struct Panel {
    const Plot& plot;
    const PlotRanges& axes;  // with their pixels
    Area area, held;         // inside the axes, and with all texts around them
    const AxisWords& words;
    const PlotStyle& style;
    PageList& list;

    bool is_map() const { return plot.map.has_value(); }
    const Axis& y_of(const Curve& curve) const { return curve.right && axes.right ? *axes.right : axes.y; }
};

/// Reduces the text sizes in `fitted` (initially `style`) until the labels and titles of a panel of this width, px, fit.
/// On paper titles are broken into lines instead. Moves notes below the titles if they do not fit beside them.
void fit_labels(const Plot& plot, float width, const PlotStyle& style, PlotStyle& fitted);

/// Height of the title's further lines and of a note below it, px.
float further_lines(const Plot& plot, float width, const PlotStyle& style);

/// The cells of the plot's map on these axes.
Image map_cells(const Plot& plot, const Axis& x, const Axis& y, const Area& area, const Theme& theme);

/// Width of a map's colour bar and its labels at the right of a panel, px. If maps share the bar, its label is above
/// it.
float bar_gutter(const HeatMap& map, float height, const PlotStyle& style);

/// The colour bar beside `area`, from `left` on: colours with ticks, and below them the colour of cells without a
/// value.
void draw_bar(const HeatMap& map, Area area, float left, const PlotStyle& style, PageList& list);

/// Space around a panel's area for its labels, px.
struct Gutters {
    float left = 0, right = 0, title = 0, labels = 0, bottom = 0;

    float top(const PlotStyle& style) const { return title + labels + 0.75f * style.tick; }
};

/// The gutters of a single panel in a cell of this size; adjacent panels share the largest.
Gutters gutters(const Plot& plot, const PlotRanges& ranges, float width, float height, const AxisWords& words,
                const PlotStyle& style);

/// Draws the panel in its cell, with the space `given` for the labels of curves, unless the axis labels leave no space.
/// Returns the space that these labels need. Sets the pixels of the axes in `ranges`.
LabelNeeds draw_panel(const Plot& plot, PlotRanges& ranges, const Area& cell, const Gutters& around,
                      const AxisWords& words, const LabelNeeds& given, const PlotStyle& style, PageList& list);

/// A curve in pixels, clipped to its panel.
struct DrawnCurve {
    std::vector<std::vector<Point>> lines;  // connected pieces
    std::vector<Point> points;              // positions of marks
    std::size_t marks_in_panel = 0;  // of all curves of the same kind (quiet or not); many marks are drawn smaller
};

/// Of the points in each half pixel column, keeps the first, last, lowest and highest: the picture is the same.
DrawnCurve drawn(const Curve& curve, const Axis& x, const Axis& y, const Area& area);

/// The colour of a curve; over a map (dark to bright) it is bright, with a dark edge.
Color curve_color(const Curve& curve, const Theme& theme, bool over_map = false);

/// The uncertainty band, if there is one.
void draw_band(const Curve& curve, const Panel& panel);

/// Lines and marks.
void draw_curve(const Curve& curve, const DrawnCurve& drawn, const Panel& panel);

/// Polylines, dashed if the curve is.
void draw_line(const std::vector<std::vector<Point>>& lines, float width, bool dashed, Color color, const Panel& panel);

}  // namespace doppel

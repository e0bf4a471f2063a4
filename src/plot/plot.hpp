#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"
#include "plot/axis.hpp"
#include "plot/page.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// An axis as the person who asks for a chart sees it.
struct PlotAxis {
    std::string label;                // with the unit: "release angle θ1, °"
    std::optional<double> low, high;  // fitted to what is drawn where not given; low > high: inverted
    bool logarithmic = false;
    std::optional<double> every;  // between ticks, as long as their labels fit: 45 for degrees

    friend bool operator==(const PlotAxis&, const PlotAxis&) = default;
};

/// What a line of data looks like. Many points of a density add up where they overlap.
enum class Mark { line, points, both, density };

/// A curve behind the others: pale and thin, or a wide pale band along it.
enum class Background { none, line, band };

/// One series. Points that are not finite, or not positive on a logarithmic axis, interrupt the line.
struct Curve {
    std::string label;  // at the line where there is room, else in the legend; empty: neither
    std::vector<double> x, y;
    std::vector<double> uncertainty;  // of y, drawn as a band; empty: none
    Mark mark = Mark::line;
    int hue = 0;                               // of the theme's palette; curves that belong together share one
    bool right = false;                        // on the second y axis
    bool dashed = false, quiet = false;        // quiet: grey and thin, to compare with
    Background background = Background::none;  // then it has no label, and labels may cover it
};

/// A straight line across the chart with a label: a limit, a time.
struct Rule {
    enum class Orientation { horizontal, vertical } orientation = Orientation::horizontal;
    double at = 0;
    std::string label;
};

/// A quantity over a rectangle as colour, with a bar that tells what the colours mean.
struct HeatMap {
    std::size_t columns = 0, rows = 0;
    std::vector<float> values;  // row by row, from y_low up; NaN = none, shown as `none_label`
    double x_low = 0, x_high = 1, y_low = 0, y_high = 1;  // outer edges of the cells, which are even on their axes
    std::string label;                                    // of the bar, with the unit
    std::string none_label;                               // "no flip within 20 s"
    bool none_is_bad = false;                             // shown in the colour of what is bad
    std::optional<double> low, high;                      // of the scale; fitted to the values where not given
    bool logarithmic = false;
    std::optional<double> threshold;  // two colours, up to it and above it
    bool shares_bar = false;          // with all maps of the figure: one bar, on the right of them
};

/// One pair of axes and what is drawn between them.
struct Plot {
    std::string title;  // of a panel among several
    std::string note;   // beside the title where there is room: a number or two
    PlotAxis x, y;
    std::optional<PlotAxis> right;
    std::optional<HeatMap> map;
    std::vector<Curve> curves;
    std::vector<Rule> rules;
    bool square = false;           // as high as wide
    bool needs_no_legend = false;  // words that have no room beside their curves stand on them
};

/// A picture fit for a paper: headings, panels in a grid, and lines of caption below.
struct Figure {
    std::string title, subtitle;
    std::vector<Plot> panels;
    int columns = 0;           // of panels; 0 = as fits
    bool shares_axes = false;  // numbers and names stand once for a row, or column, of panels whose axes are alike
    std::vector<std::string> captions;  // paragraphs, broken into lines
};

/// A map's scale of colours.
struct MapScale {
    explicit MapScale(const HeatMap& map);

    Axis axis;                        // from its own ends, or those of its numbers
    std::optional<double> step = {};  // share of the axis at which the one of two colours ends
    Color color(double share) const;
};
/// A map by itself, a pixel a cell, the first row at the bottom.
Picture cell_picture(const HeatMap& map, const Theme& theme);

/// Composes a figure for a picture of `size` px. `scale` = 2 gives every length twice as many pixels: the same layout
/// as a picture of half the size, for print. Text of labels is 20 px times `unit` and scale, the rest in proportion; by the
/// size where it is not given. Text never overlaps: what does not fit is shrunk, in all panels alike, moved to the legend,
/// which covers no data, or left out (tick labels).
Page compose(const Figure& figure, Size size, const Theme& theme, float scale = 1, std::optional<float> unit = {});

}  // namespace doppel

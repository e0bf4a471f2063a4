#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"
#include "plot/axis.hpp"
#include "plot/page.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// An axis as specified for a chart.
struct PlotAxis {
    std::string label;                // including the unit: "release angle θ1, °"
    std::optional<double> low, high;  // fitted to the contents if not given; low > high: inverted
    bool logarithmic = false;
    std::optional<double> every;  // distance of ticks, as long as their labels fit: 45 for degrees
    std::vector<Tick> ticks;      // ascending, in place of those, where their labels fit

    friend bool operator==(const PlotAxis&, const PlotAxis&) = default;
};

/// How data are drawn. In `density`, many overlapping points add up.
enum class Mark { line, points, both, density };

/// A curve behind the others: a pale thin line, or a wide pale band.
enum class Background { none, line, band };

/// One series. Values that are not finite, or not positive on a logarithmic axis, interrupt the line.
struct Curve {
    std::string label;  // at the curve if there is space, otherwise in the legend; empty: none
    std::vector<double> x, y;
    std::vector<double> uncertainty;  // of y, drawn as a band; empty: none
    Mark mark = Mark::line;
    int hue = 0;                               // index in the theme's palette; beyond its end, colours repeat, dashed
    bool right = false;                        // belongs to the second y axis
    bool dashed = false, quiet = false;        // quiet: grey and thin, for comparison
    Background background = Background::none;  // a background curve has no label, and labels may cover it
};

/// A labelled straight line across the chart: a limit, a time.
struct Rule {
    enum class Orientation { horizontal, vertical } orientation = Orientation::horizontal;
    double at = 0;
    std::string label;
};

/// A quantity on a rectangle, shown as colour with a colour bar. Its cells are equidistant on the plot's x and y, from
/// their low to their high ends, which must be given.
struct HeatMap {
    std::size_t columns = 0, rows = 0;
    std::vector<float> values;        // row by row, from the lowest up; NaN = no value, shown as `none_label`
    std::string label;                // of the colour bar, including the unit
    std::string none_label;           // "no flip within 20 s"
    bool none_is_bad = false;         // shown in the theme's `bad` colour
    std::optional<double> low, high;  // of the colour scale; fitted to the values if not given
    bool logarithmic = false;
    std::optional<double> threshold;  // only two colours: up to this value, and above it
    bool shares_bar = false;          // one colour bar for all maps of the figure, at their right
};

/// A pair of axes and its contents.
struct Plot {
    std::string title;  // of one panel among several
    std::string note;   // short text beside the title, if there is space
    PlotAxis x, y;
    std::optional<PlotAxis> right;
    std::optional<HeatMap> map;
    std::vector<Curve> curves;
    std::vector<Rule> rules;
    bool square = false;           // as high as wide
    bool needs_no_legend = false;  // labels without space beside their curves are written on them
};

/// A complete figure: headings, panels in a grid, and captions below.
struct Figure {
    std::string title, subtitle;
    std::vector<Plot> panels;
    int columns = 0;                    // of panels; 0 = automatic
    bool shares_axes = false;           // numbers and labels of equal axes are shown once for each row and column
    std::vector<std::string> captions;  // paragraphs, broken into lines
};

struct MapScale {
    explicit MapScale(const HeatMap& map);

    Axis axis;                        // from its given ends, or those of its values
    std::optional<double> step = {};  // position on the axis where the first of two colours ends
    Color color(double share) const;
};
/// The ticks of a colour bar. A threshold, where two colours meet, is always one.
std::vector<Tick> bar_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> threshold);
/// The colour of cells without a value.
Color none_color(const HeatMap& map, const Theme& theme);
/// A picture of the map alone, one pixel per cell, the first row at the bottom.
Picture cell_picture(const HeatMap& map, const Theme& theme);

/// Lays out a figure for a picture of `size` px, with `scale` px for each of the layout. Labels have 20 px times `unit`
/// and scale, other text is in proportion; without `unit` the size decides. Text never overlaps. What does not fit is
/// shrunk in all panels alike, moved to the legend, which covers no data, or left out (tick labels).
Page compose(const Figure& figure, Size size, const Theme& theme, float scale = 1, std::optional<float> unit = {});

/// Panels with a shorter side are not drawn, px.
inline constexpr float drawn_side = 8;
/// Whether all have these sides, px.
bool have_sides(const std::vector<PlotRanges>& panels, float width, float height);

}  // namespace doppel

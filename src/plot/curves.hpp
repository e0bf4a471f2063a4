#pragma once

#include "plot/axis.hpp"
#include "plot/chart_parts.hpp"
#include "plot/plot.hpp"

namespace doppel {

/// A curve in pixels, cut to its panel.
struct DrawnCurve {
    std::vector<std::vector<Point>> lines;  // pieces
    std::vector<Point> points;              // where a mark is due
    std::size_t marks_in_panel = 0;         // the more, the smaller they are drawn
};

/// Of many points in half a column of pixels the first, the last, the lowest and the highest stay: no pixel tells the
/// difference.
DrawnCurve drawn(const Curve& curve, const Axis& x, const Axis& y, const Area& area);

/// In what colour a curve is drawn; over a map (dark to bright) bright, with a dark edge.
Color curve_color(const Curve& curve, const PlotStyle& style, bool over_map);

/// The band of its uncertainty, if it has one.
void draw_band(const Curve& curve, const Axis& x, const Axis& y, const Area& area, const PlotStyle& style,
               DisplayList& list);

/// Lines and marks.
void draw_curve(const Curve& curve, const DrawnCurve& drawn, const Area& area, const PlotStyle& style, bool over_map,
                DisplayList& list);

/// From one place to another, with gaps if it is dashed, as all curves are.
void draw_line(const std::vector<std::vector<Point>>& lines, float width, bool dashed, Color color,
               const PlotStyle& style, DisplayList& list);

// Parts of a chart that are cheaper, or only possible, pixel by pixel: images for the pixels that `scale` makes of each
// px.

/// Discs around many points, which do not add up where they overlap; cut off at the edges of `area`.
Image scatter_image(const std::vector<Point>& points, float radius, Color color, const Area& area, float scale);

/// The area between low[i] and high[i] over x[i], px; where one is NaN there is a gap.
struct Band {
    std::vector<double> x, low, high;
};
Image band_image(const Band& band, Color color, const Area& area, float scale);

}  // namespace doppel

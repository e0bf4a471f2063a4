#pragma once

#include "plot/fit.hpp"
#include "plot/style.hpp"

namespace doppel {

/// The map's cells in `area` as seen through the axes: crisp where they are larger than pixels, else averaged, the
/// logarithm where the scale is logarithmic. Below zero on such a scale is as good as no value.
Image map_image(const HeatMap& map, const Axis& scale_of_colors, const Axis& x, const Axis& y, const Area& area,
                Color none, float scale);

/// px that the colour bar of a map and its labels take on the right of a panel `height` px high.
float bar_gutter(const HeatMap& map, float height, const PlotStyle& style);

/// The bar beside `area`, from `left` on: colours with ticks, and below them what stands for no value.
void draw_bar(const HeatMap& map, const Area& area, float left, const PlotStyle& style, DisplayList& list);

/// The same for a bar that maps share, with its label above it.
float shared_bar_gutter(const HeatMap& map, float height, const PlotStyle& style);
void draw_shared_bar(const HeatMap& map, const Area& area, float left, const PlotStyle& style, DisplayList& list);

/// The colour of what has no value.
Color none_color(const HeatMap& map, const Theme& theme);

}  // namespace doppel

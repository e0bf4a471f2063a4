#pragma once

#include "plot/axis.hpp"
#include "plot/plot.hpp"
#include "plot/style.hpp"

namespace doppel {

/// Ticks with labels beside a vertical axis, and below a horizontal one.
std::vector<Tick> y_ticks(const Axis& axis, const PlotAxis& asked, const PlotStyle& style);
std::vector<Tick> x_ticks(const Axis& axis, const PlotAxis& asked, const PlotStyle& style);

/// The grid, the axes, their ticks with labels, and the x axis's label. No text leaves `held`; `right` may be null.
void draw_axes(const Plot& plot, const Axis& x, const Axis& y, const Axis* right, const Area& area, const Area& held,
               const PlotStyle& style, DisplayList& list);

/// px that the labels above a panel `width` px wide take: one line if all fit side by side, else one each.
float axis_labels_height(const Plot& plot, float width, const PlotStyle& style);

/// The panel's title in the uppermost `title` px of `held`; in the `labels` px below, the labels of the vertical axes
/// and of the map's bar.
void draw_headings(const Plot& plot, const Area& held, float title, float labels, const PlotStyle& style,
                   DisplayList& list);

}  // namespace doppel

#pragma once

#include "plot/fit.hpp"
#include "plot/style.hpp"

namespace doppel {

/// px around a panel's area for its labels.
struct Gutters {
    float left = 0, right = 0, title = 0, labels = 0, bottom = 0;

    float top(const PlotStyle& style) const { return title + labels + 0.75f * style.tick; }
};

/// Of a panel alone in a cell of this size; panels beside each other share the largest.
Gutters gutters(const Plot& plot, const PlotRanges& ranges, float width, float height, const PlotStyle& style);

/// The larger of each.
Gutters united(const Gutters& a, const Gutters& b);

/// The panel in its cell. Nothing where the labels leave it no room.
void draw_panel(const Plot& plot, const PlotRanges& ranges, const Area& cell, const Gutters& around,
                const PlotStyle& style, DisplayList& list);

}  // namespace doppel

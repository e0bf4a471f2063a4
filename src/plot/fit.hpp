#pragma once

#include "plot/axis.hpp"
#include "plot/plot.hpp"

namespace doppel {

/// The ranges of a panel's axes.
struct PlotRanges {
    Axis x, y;
    std::optional<Axis> right;
};

/// What was asked for; the rest holds all that is drawn, with a little margin (none around a map, none below a zero).
PlotRanges fitted_ranges(const Plot& plot);

/// The range of a map's colours.
Axis fitted_scale(const HeatMap& map);

/// Throws bad_input where a figure cannot be drawn: series of unequal length, a logarithm of nothing, …
void check(const Figure& figure);

}  // namespace doppel

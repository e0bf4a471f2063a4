#pragma once

#include "plot/curves.hpp"
#include "plot/label_placer.hpp"

namespace doppel {

/// Writes the rules' words beside them, where least is in the way.
void label_rules(const std::vector<Rule>& rules, const Axis& x, const Axis& y, const PlotStyle& style, bool over_map,
                 LabelPlacer& room, DisplayList& list);

/// Names the curves: each at its line where words touch nothing, the others in a legend in the emptiest place; where
/// curves are many, upon their lines. Curve i has drawn in `room` as number i.
void label_curves(const std::vector<Curve>& curves, const std::vector<DrawnCurve>& drawn, const PlotStyle& style,
                  bool over_map, LabelPlacer& room, DisplayList& list);

}  // namespace doppel

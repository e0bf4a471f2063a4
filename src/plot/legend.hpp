#pragma once

#include "plot/curves.hpp"
#include "plot/label_placer.hpp"

#include <optional>

namespace doppel {

/// Names of curves beside a piece of each, in a box.
struct Legend {
    std::vector<std::size_t> which;  // of the curves
    Area box;
    float size;  // of text, px an em
};

/// In the emptiest place of the panel, preferably a corner, away from all words. It shrinks before it gives up.
std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which,
                                    const PlotStyle& style, const LabelPlacer& room);

void draw_legend(const Legend& legend, const std::vector<Curve>& curves, const PlotStyle& style, bool over_map,
                 DisplayList& list);

}  // namespace doppel

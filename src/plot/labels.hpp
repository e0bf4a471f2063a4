#pragma once

#include "plot/curves.hpp"
#include "plot/style.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace doppel {

/// Where in a panel there is ink already: who drew in which small square, and where words stand.
class LabelPlacer {
public:
    explicit LabelPlacer(const Area& area);

    /// Marks the segment as drawn by number `who`.
    void add_line(Point from, Point to, std::size_t owner);
    void add_text(const Area& box) { texts_.push_back(box); }

    /// How many squares in `box` anyone but `except` has drawn in.
    int ink(const Area& box, std::size_t except = no_owner) const;
    /// Within the panel, and no words there.
    bool is_free(const Area& box) const;

    const Area& area() const { return area_; }
    static constexpr std::size_t no_owner = 63;

private:
    struct Squares {
        int left, top, right, bottom;
    };
    Squares squares(const Area& box) const;

    Area area_;
    int columns_, rows_;
    std::vector<std::uint64_t> drawn_;  // by square, a bit for each number
    std::vector<Area> texts_;
};

/// Names of curves beside a piece of each, in a box.
struct Legend {
    std::vector<std::size_t> which;  // of the curves
    Area box;
    float size;  // of text, px an em
};

/// In the emptiest place of the panel, preferably a corner, away from all words. It shrinks before it gives up.
std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which,
                                    const PlotStyle& style, const LabelPlacer& placer);

void draw_legend(const Legend& legend, const std::vector<Curve>& curves, const PlotStyle& style, bool over_map,
                 DisplayList& list);

/// Writes the rules' words beside them, where least is in the way.
void label_rules(const std::vector<Rule>& rules, const Axis& x, const Axis& y, const PlotStyle& style, bool over_map,
                 LabelPlacer& placer, DisplayList& list);

/// Names the curves: each at its line where words touch nothing, the others in a legend in the emptiest place; where
/// curves are many, upon their lines. Curve i has drawn in `room` as number i.
void label_curves(const std::vector<Curve>& curves, const std::vector<DrawnCurve>& drawn, const PlotStyle& style,
                  bool over_map, LabelPlacer& placer, DisplayList& list);

}  // namespace doppel

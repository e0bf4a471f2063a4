#pragma once

#include "plot/chart_parts.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace doppel {

/// What is drawn in a panel already: which curve in which small square, and where labels are.
class LabelPlacer {
public:
    explicit LabelPlacer(const Area& area);

    /// Marks the segment as drawn by curve number `owner`.
    void add_line(Point from, Point to, std::size_t owner);
    void add_text(const Area& box) { texts_.push_back(box); }

    /// How many squares in `box` are drawn in by other curves than `except`.
    int ink(const Area& box, std::size_t except = no_owner) const;
    /// Within the panel, and no label there.
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

/// Names of curves beside a sample of each, in a box.
struct Legend {
    std::vector<std::size_t> which;  // of the curves
    Area box;
    float size;  // of text, px an em
};

/// In the emptiest place of the panel, preferably a corner, away from all labels; shrunk if need be. Nothing where it
/// does not fit.
std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which,
                                    const PlotStyle& style, const LabelPlacer& placer);

void draw_legend(const Legend& legend, const std::vector<Curve>& curves, const PlotStyle& style, bool over_map,
                 DisplayList& list);

/// Writes the rules' labels beside them, where they hide least.
void label_rules(const std::vector<Rule>& rules, const Axis& x, const Axis& y, const PlotStyle& style, bool over_map,
                 LabelPlacer& placer, DisplayList& list);

/// Labels the curves: at the line where a label touches nothing, else in a legend in the emptiest place; where curves
/// are many, on their lines. Curve i has drawn in `placer` as number i.
void label_curves(const std::vector<Curve>& curves, const std::vector<DrawnCurve>& drawn, const PlotStyle& style,
                  bool over_map, LabelPlacer& placer, DisplayList& list);

}  // namespace doppel

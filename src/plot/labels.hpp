#pragma once

#include "plot/axis.hpp"
#include "plot/chart_parts.hpp"
#include "plot/plot.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
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

/// In a place of the panel where nothing is drawn, preferably a corner, away from all labels; nothing where there is none.
std::optional<Legend> fitted_legend(const std::vector<Curve>& curves, std::vector<std::size_t> which, float size,
                                    const LabelPlacer& placer);

/// px that the names of all curves take beside a panel.
float legend_gutter(const std::vector<Curve>& curves, float size);
/// In the upper left corner of `area`, text of at most so many px an em.
Legend legend_in(const Area& area, const std::vector<Curve>& curves, std::vector<std::size_t> which, float most);

void draw_legend(const Legend& legend, const std::vector<Curve>& curves, const PlotStyle& style, bool over_map,
                 PageList& list);

/// Writes the rules' labels beside them, where they hide least.
void label_rules(const std::vector<Rule>& rules, const Axis& x, const Axis& y, const PlotStyle& style, bool over_map,
                 LabelPlacer& placer, PageList& list);

/// Labels the curves: at the line where a label touches nothing, smaller if need be, else in a legend that covers nothing;
/// where curves are many, or there is no place for a legend, on their lines; what then is left in a legend in `beside`, the
/// room on the right of the panel that is `given`. Curve i has drawn in `placer` as number i. Returns what they need.
LabelNeeds label_curves(const Plot& plot, const std::vector<DrawnCurve>& drawn, const LabelNeeds& given,
                        const Area& beside, const PlotStyle& style, const LabelPlacer& placer, PageList& list);

/// Where the ink of a line of text may be, with the tallest accents and the deepest tails of the font.
Area text_area(const Label& label);

/// `text` in lines no wider than `width` px, broken at spaces and at '\n', but not within a number or between it and its
/// unit; a word that is wider itself is broken anywhere.
std::vector<std::string> wrapped(std::string_view text, float size, Weight weight, float width);

/// The same in as many lines, all of them shorter where else the last would be less than a third of a line.
std::vector<std::string> evenly_wrapped(std::string_view text, float size, Weight weight, float width);

/// The width of the widest, px.
float widest(const std::vector<std::string>& lines, float size);
float widest(const std::vector<Tick>& ticks, float size);

/// Lines of one kind below one another.
struct TextBlock {
    std::vector<std::string> lines;
    float size = 16;  // px an em
    Weight weight = Weight::regular;
    Color color;

    float line_height() const { return 1.36f * size; }
    float height() const { return line_height() * static_cast<float>(lines.size()); }
    /// With its top left corner at `at`.
    void draw(Point at, PageList& list) const;
};

/// One line in as much as `width` px: shrunk to three quarters, but not below 9 px, if need be, then broken.
TextBlock fitted_block(std::string_view text, float size, Weight weight, Color color, float width);

}  // namespace doppel

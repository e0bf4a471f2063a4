#pragma once

#include "plot/axis.hpp"
#include "plot/panel.hpp"
#include "plot/plot.hpp"
#include "render/typeface.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace doppel {

/// What is already drawn in a panel: the curves in each small square, and the areas of labels.
class LabelPlacer {
public:
    explicit LabelPlacer(const Area& area);

    /// Marks the squares along the segment as drawn by curve number `owner`.
    void add_line(Point from, Point to, std::size_t owner);
    void add_text(const Area& box) { texts_.push_back(box); }

    /// The number of squares in `box` in which curves other than `except` are drawn.
    int ink(const Area& box, std::size_t except = no_owner) const;
    /// Whether the area is inside the panel and contains no label.
    bool is_free(const Area& box) const;

    const Area& area() const { return area_; }
    static constexpr std::size_t no_owner = 63;

private:
    Area area_;
    int columns_, rows_;
    std::vector<std::uint64_t> drawn_;  // for each square, one bit per curve number
    std::vector<Area> texts_;
};

/// Writes the labels of rules beside them, where they hide the least.
void label_rules(const Panel& panel, LabelPlacer& placer);

/// Labels the curves: beside each curve where the label touches nothing, smaller if necessary, otherwise in a legend
/// that covers nothing; on the curves if they are many or there is no place for a legend. Curve i has number i in
/// `placer`. Returns the space that the labels need. A legend `given` at the right of the panel has all names.
LabelNeeds label_curves(const std::vector<DrawnCurve>& drawn, const LabelNeeds& given, const LabelPlacer& placer,
                        const Panel& panel);

/// `text` in lines no wider than `width` px. Lines break at spaces and '\n', but not within a number, or between a
/// number and its unit. A word that is wider than a line is broken after a hyphen, or anywhere.
std::vector<std::string> wrapped(std::string_view text, float size, Weight weight, float width,
                                 const Typeface& type = {});

/// The same number of lines, but all of them shorter if the last would be less than a third of a line.
std::vector<std::string> evenly_wrapped(std::string_view text, float size, Weight weight, float width);

/// The width of the widest line, px.
float widest(const std::vector<std::string>& lines, float size);
float widest(const std::vector<Tick>& ticks, float size);

/// Lines of the same style, one below the other.
struct TextBlock {
    std::vector<std::string> lines;
    float size = 16;  // px per em
    Weight weight = Weight::regular;
    Color color;

    float line_height() const { return 1.36f * size; }
    float height() const { return line_height() * static_cast<float>(lines.size()); }
    /// Draws the block with its top left corner at `at`.
    void draw(Point at, PageList& list) const;
};

}  // namespace doppel

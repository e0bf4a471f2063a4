#pragma once

#include "plot/axis.hpp"
#include "plot/chart_parts.hpp"
#include "plot/plot.hpp"

#include <string_view>

namespace doppel {

/// Where the ink of a line of text may be, with the tallest accents and the deepest tails of the font.
Area text_area(const Label& label);

/// `text` in lines no wider than `width` px, broken at spaces and at '\n'; a word that is wider itself is broken
/// anywhere.
std::vector<std::string> wrapped(std::string_view text, float size, Weight weight, float width);

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
    void draw(Point at, DisplayList& list) const;
};

/// One line in as much as `width` px: shrunk to three quarters, but not below 9 px, if need be, then broken.
TextBlock fitted_block(std::string_view text, float size, Weight weight, Color color, float width);

/// The size of text at which the table fits into `area`, px an em.
float fitting_table_size(const PlotTable& table, const Area& area, const PlotStyle& style);

/// The table in `area`, its text shrunk until all fits.
void draw_table(const PlotTable& table, const Area& area, const PlotStyle& style, DisplayList& list);

}  // namespace doppel

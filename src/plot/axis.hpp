#pragma once

#include "render/display_list.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A tick of an axis; `text` is its label, empty if it has none.
struct Tick {
    double value;
    std::string text;

    friend bool operator==(const Tick&, const Tick&) = default;
};
/// A tick labelled with its value, to ten digits.
Tick tick_at(double value);

/// Maps the values low…high (both > 0 if logarithmic; low > high: inverted) to the pixels from…to, linearly or
/// logarithmically. If low = high, all values map to the middle.
struct Axis {
    double low = 0, high = 1;
    float from = 0, to = 1;  // px
    bool logarithmic = false;

    /// Position along the axis, 0 at low and 1 at high; values outside the range give positions outside. NaN without a
    /// logarithm.
    double share(double value) const;

    /// Position in px, where share() is.
    double pixel(double value) const { return from + (static_cast<double>(to) - from) * share(value); }
    /// The same, clamped to the ends, so that a curve stays in its panel.
    float at(double value) const;
};

/// The axes of a panel, with their ranges.
struct PlotRanges {
    Axis x, y;
    std::optional<Axis> right;
};

/// "10⁻⁴"; 0.1, 1 and 10 are written as such.
std::string power_of_ten(int exponent);

struct TickLabels {
    float size = 19;     // px per em
    float gap = 12;      // px between labels
    float spacing = 40;  // least distance between ticks, px
    bool across = true;  // a horizontal axis: widths of labels count, otherwise their heights

    /// The space that `text` takes along the axis, px.
    float length(const std::string& text) const;
};

/// Ticks of a chart, ascending, with distinct labels at least `gap` apart: multiples of `every` (or of twice, four times …
/// as much) if it is given and two of them fit; otherwise of 1, 2 or 5 times a power of ten. A logarithmic axis has
/// decades; over less than two also 2 and 5, or 3, times a decade. Labels have the digits of the step, and the form
/// "1.5 × 10⁻⁷" below 0.0001 and from a million on. None if doubles cannot distinguish neighbouring ticks.
std::vector<Tick> chart_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> every = {});

/// The ticks with the spacing of figures and films: labels of `em` px below a chart (`across`) or beside it. `own` = the
/// ticks, ascending, that are taken where their labels fit.
std::vector<Tick> spaced_ticks(const Axis& axis, bool across, float em, std::optional<double> every = {},
                               const std::vector<Tick>& own = {});

/// How an axis is drawn. Sizes in px.
struct AxisStyle {
    enum class Edge { bottom, left, right } edge = Edge::left;  // of the chart
    float em = 19;                                              // size of the numbers
    float line = 1;                                             // line width; 0 = none
    Color grid, frame, text;
    bool has_grid = true, has_numbers = true;
    std::string unit = {};  // appended to the last number of a horizontal axis
};

/// The axis of a chart in `area`: grid lines at labelled ticks, marks outside, and labels. Labels below the chart that
/// are not inside `within` are left out.
DisplayList axis_items(const Axis& axis, const std::vector<Tick>& ticks, const Area& area, const Area& within,
                       const AxisStyle& style);

}  // namespace doppel

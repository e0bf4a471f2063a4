#pragma once

#include "render/display_list.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A tick of an axis; `text` is its label, empty where it has none.
struct Tick {
    double value;
    std::string text;
};

/// Maps the values low…high (both > 0 if logarithmic; low > high: inverted) to the pixels from…to, in a straight line
/// or by powers of ten. Without width it maps all to the middle.
struct Axis {
    double low = 0, high = 1;
    float from = 0, to = 1;  // px
    bool logarithmic = false;

    /// How far along the axis, 0 at low and 1 at high; beyond, outside. NaN where it has no logarithm.
    double share(double value) const;

    /// px; values outside are moved to the nearest end, so that a trace stays in its frame.
    float at(double value) const;
};

/// "10⁻⁴"; 1 and 10 are written as people write them.
std::string power_of_ten(int exponent);

/// Size and spacing of the labels at ticks.
struct TickLabels {
    float size = 19;     // px an em
    float gap = 12;      // px between labels
    float spacing = 40;  // px between ticks, at least
    bool across = true;  // the axis is horizontal: labels need their width, else their height

    /// px that `text` takes along the axis.
    float length(const std::string& text) const;
};

/// Ticks of a chart, ascending, with distinct labels at least `gap` apart: multiples of `every` (or of twice, four
/// times … as much) where it is given and two of them fit, else 1, 2 or 5 times a power of ten. On a logarithmic axis
/// whole decades (and ticks without labels within), over less than two decades also their double and fivefold, or their
/// threefold; where `every` is given, every so many decades have a label. Never more digits than the step has; "1.5 ×
/// 10⁻⁷" below 0.0001 and from a million on; a true minus sign. None where a double cannot tell neighbours apart.
std::vector<Tick> chart_ticks(const Axis& axis, const TickLabels& labels, std::optional<double> every = {});

/// The same with the spacing that figures and films have: labels of `em` px below a chart (`across`) or beside it.
std::vector<Tick> spaced_ticks(const Axis& axis, bool across, float em, std::optional<double> every = {});

/// How an axis is drawn. Sizes in px.
struct AxisLook {
    enum class Edge { bottom, left, right } edge = Edge::left;  // of the chart
    float em = 19;                                              // of the numbers
    float line = 1;                                             // width of lines; 0 = none
    Color grid, frame, text;
    bool has_grid = true, has_numbers = true;
    std::string unit = {};  // after the last number of an axis below
};

/// Of a chart in `area`: lines across it at ticks that have labels, marks outside it, and the labels. Those below it that
/// do not fit `within` are left out.
DisplayList axis_items(const Axis& axis, const std::vector<Tick>& ticks, const Area& area, const Area& within,
                       const AxisLook& look);

}  // namespace doppel

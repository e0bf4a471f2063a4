#pragma once

#include "plot/axis.hpp"

#include <optional>

namespace doppel {

/// What the words at the ticks of an axis need.
struct TickWords {
    float size = 19;     // px an em
    float gap = 12;      // px between words
    float spacing = 40;  // px between ticks, at least
    bool across = true;  // the axis is horizontal: words need their width, else their height

    /// px that `text` takes along the axis.
    float length(const std::string& text) const;
};

/// Ticks of a chart, ascending, with distinct words that do not come closer than `gap`: multiples of `every` (or of
/// twice, four times … as much) where it is given and two of them fit, else 1, 2 or 5 times a power of ten. On a
/// logarithmic axis whole decades (and nameless ticks within), over less than two decades also their double and
/// fivefold. Never more digits than the step has; "1.5 × 10⁻⁷" below 0.0001 and from a million on; a true minus sign.
/// None where a double cannot tell neighbours apart.
std::vector<Tick> chart_ticks(const Axis& axis, const TickWords& words, std::optional<double> every = {});

}  // namespace doppel

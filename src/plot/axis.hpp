#pragma once

#include <string>
#include <vector>

namespace doppel {

/// A mark on an axis and its words; `text` is empty where a line is enough.
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

    /// How far along the axis, 0 at low and 1 at high; beyond, outside. Not a number where a logarithm is none.
    double share(double value) const;

    /// px; values outside are moved to the nearest end, so that a trace stays in its frame.
    float at(double value) const;
};

/// "10⁻⁴"; 1 and 10 are written as people write them.
std::string power_of_ten(int exponent);

/// Whole decades within the axis, in words "10⁻⁴", as many labelled as fit with `label_px` between them.
std::vector<Tick> decade_ticks(const Axis& axis, float label_px);

/// Round values (1, 2, 5 times a power of ten), labels at least `label_px` apart.
std::vector<Tick> round_ticks(const Axis& axis, float label_px);

}  // namespace doppel

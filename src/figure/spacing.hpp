#pragma once

#include "scene/field.hpp"

#include <array>
#include <cmath>

namespace doppel {

/// The spacing of a parameter's values: equal differences, or equal ratios.
enum class Spacing { linear, logarithmic };
template <>
inline constexpr auto names_of<Spacing> = std::to_array<std::string_view>({"linear", "logarithmic"});
inline constexpr std::string_view spacing_help = "by equal differences, or by equal ratios";

/// Equal cells between two ends.
struct CellRange {
    double from = 0, to = 1;
    int count = 200;
    Spacing spacing = Spacing::linear;

    bool is_logarithmic() const { return spacing == Spacing::logarithmic; }
    /// The centre of a cell. If the ends are opposite numbers, mirror images have exactly opposite centres.
    double middle(int cell) const {
        const double before = 2.0 * cell + 1, after = 2.0 * count - before;  // in half cells
        if (is_logarithmic()) return from * std::pow(to / from, before / (2.0 * count));
        return (from * after + to * before) / (2.0 * count);
    }
};

}  // namespace doppel

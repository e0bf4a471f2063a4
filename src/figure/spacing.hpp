#pragma once

#include "scene/field.hpp"

#include <array>
#include <cmath>

namespace doppel {

/// How the values of a parameter follow each other: by equal differences, or by equal ratios.
enum class Spacing { linear, logarithmic };
template <>
inline constexpr auto names_of<Spacing> = std::to_array<std::string_view>({"linear", "logarithmic"});
inline constexpr std::string_view spacing_help = "by equal differences, or by equal ratios";

/// Cells of equal size between two ends.
struct Cells {
    double from = 0, to = 1;
    int count = 200;
    Spacing spacing = Spacing::linear;

    bool is_logarithmic() const { return spacing == Spacing::logarithmic; }
    /// The middle of a cell. Of ends that are opposite numbers, mirror images have exactly opposite middles.
    double middle(int cell) const {
        const double place = static_cast<double>(2 * cell + 1 - count) / count;  // −1 … 1
        if (is_logarithmic()) return std::sqrt(from * to) * std::pow(to / from, 0.5 * place);
        return 0.5 * (from + to) + 0.5 * (to - from) * place;
    }
};

}  // namespace doppel

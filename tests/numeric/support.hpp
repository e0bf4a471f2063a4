#pragma once

#include "numeric/quad.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace doppel {

inline std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

/// The error in units of the last place of the exact value.
inline double ulps(double value, const Quad& exact) {
    const double near = std::abs(static_cast<double>(exact));
    const double unit = std::nextafter(near, std::numeric_limits<double>::infinity()) - near;
    return std::abs(static_cast<double>(Quad(Quad(value) - exact))) / unit;
}

}  // namespace doppel

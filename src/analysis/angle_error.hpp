#pragma once

#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace doppel {

/// The largest difference between an angle of one and of the other, rad, up to whole turns: 0 … π. NaN where a number
/// is none. Either may be in quad; the difference is then taken in quad.
template <class One, class Other>
double angle_error(const Bobs<One>& one, const Bobs<Other>& other) {
    using Wide = std::conditional_t<std::is_same_v<One, double>, Other, One>;
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const auto apart = static_cast<double>(Wide(Wide(one[i].theta) - Wide(other[i].theta)));
        const double error = std::abs(std::remainder(apart, 2 * pi));
        if (!std::isfinite(error)) return error;
        worst = std::max(worst, error);
    }
    return worst;
}

/// The largest difference between a place of one and of the other, m: the error of what hangs in no chain.
template <class One, class Other>
double place_error(const Bobs<One>& one, const Bobs<Other>& other) {
    using Wide = std::conditional_t<std::is_same_v<One, double>, Other, One>;
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const double error = std::hypot(static_cast<double>(Wide(Wide(one[i].x) - Wide(other[i].x))),
                                        static_cast<double>(Wide(Wide(one[i].y) - Wide(other[i].y))));
        if (!std::isfinite(error)) return error;
        worst = std::max(worst, error);
    }
    return worst;
}

}  // namespace doppel

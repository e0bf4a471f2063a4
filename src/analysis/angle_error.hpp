#pragma once

#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace doppel {

/// How far one angle is from another, rad, up to whole turns: 0 … π. NaN where one is none. Either may be in quad; the
/// turns are then taken off in quad, or nothing below their rounding in double, 2e-16 a turn, could be seen.
template <class One, class Other>
double angle_between(const One& one, const Other& other) {
    using Wide = std::conditional_t<std::is_same_v<One, double>, Other, One>;
    using std::remainder;
    const Wide turn = 2 * pi_of<Wide>();
    return std::abs(static_cast<double>(Wide(remainder(Wide(Wide(one) - Wide(other)), turn))));
}

/// The largest angle_between() of the bobs of one and of the other; NaN where a number is none.
template <class One, class Other>
double angle_error(const Bobs<One>& one, const Bobs<Other>& other) {
    double worst = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        const double error = angle_between(one[i].theta, other[i].theta);
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

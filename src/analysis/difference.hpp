#pragma once

#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

namespace doppel {

/// How far apart two systems of as many masses are in state space: the Euclidean norm of the difference of
/// (m, x, vx, y, vy) over all masses, in SI numbers, so that a difference in mass counts.
template <class Scalar>
Scalar state_space_distance(const Bobs<Scalar>& a, const Bobs<Scalar>& b) {
    using std::sqrt;
    Scalar sum(0);
    const auto add = [&](const Scalar& difference) { sum += difference * difference; };
    for (std::size_t i = 0; i < a.size(); ++i) {
        // in the order of memory: GCC 12 at -O3 sums in that order whatever stands here, and the last bit depends on it
        add(a[i].mass - b[i].mass);
        add(a[i].x - b[i].x);
        add(a[i].y - b[i].y);
        add(a[i].vx - b[i].vx);
        add(a[i].vy - b[i].vy);
    }
    return sqrt(sum);
}

/// λ = ln(d / d0), the study's measure of divergence: dimensionless, not an exponent per second. Nothing where d0 or d
/// is 0.
inline std::optional<double> log_ratio(double distance, double start) {
    if (start == 0 || distance == 0) return std::nullopt;
    return portable_log(distance / start);
}

/// How far one angle is from another, rad, up to whole turns: 0 … π. NaN where one is NaN. Either may be in quad; the
/// turns are then taken off in quad, or nothing below their rounding in double, 2e-16 a turn, could be seen.
template <class One, class Other>
double angle_between(const One& one, const Other& other) {
    using Wide = std::conditional_t<std::is_same_v<One, double>, Other, One>;
    using std::remainder;
    const Wide turn = 2 * pi_of<Wide>();
    return std::abs(static_cast<double>(Wide(remainder(Wide(Wide(one) - Wide(other)), turn))));
}

/// The largest angle_between() of the bobs of one and of the other; NaN where a number is NaN.
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
        const auto x = static_cast<double>(Wide(Wide(one[i].x) - Wide(other[i].x)));
        const auto y = static_cast<double>(Wide(Wide(one[i].y) - Wide(other[i].y)));
        const double error = std::sqrt(x * x + y * y);
        if (!std::isfinite(error)) return error;
        worst = std::max(worst, error);
    }
    return worst;
}

/// What an energy error is a fraction of, J: |E0|, or the potential range where E0 is zero (below the rounding of a
/// start that is given in degrees: cos 90° is 6e-17 in double).
inline double energy_scale(double start_energy, double potential_range) {
    return std::abs(start_energy) > 1e-13 * potential_range ? std::abs(start_energy) : potential_range;
}

/// What the energy of a motion may gain, J: ten times all the energy there is; no true motion gains that, and a run that
/// does has broken down.
inline double greatest_gain(double start_energy, double kinetic_energy, double potential_range) {
    return 10 * (potential_range + std::abs(start_energy) + kinetic_energy);
}

}  // namespace doppel

#pragma once

#include "physics/bob.hpp"

#include <cmath>
#include <optional>

namespace doppel {

/// How far apart two systems of as many masses are in state space: the Euclidean norm of the difference of
/// (m, x, vx, y, vy) over all masses, in SI numbers, so that a difference in mass counts.
template <class Scalar>
Scalar state_space_distance(const Bobs<Scalar>& a, const Bobs<Scalar>& b) {
    using std::sqrt;
    Scalar sum(0);
    const auto add = [&](const Scalar& difference) { sum += difference * difference; };
    for (std::size_t i = 0; i < a.size(); ++i) {
        // in the order of memory: GCC 12 at -O3 sums in that order whatever stands here, and the last bit would hang on
        // it
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
    return std::log(distance / start);
}

}  // namespace doppel

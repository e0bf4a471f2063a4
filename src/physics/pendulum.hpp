#pragma once

#include "numeric/sin_cos.hpp"
#include "numeric/state.hpp"

#include <algorithm>

namespace doppel {

/// A chain of point masses on massless rigid rods, and its release; the same for every model. Link i hangs from link i
/// − 1.
///
///     pivot o──l1──● m1        angles θ from the downward vertical, counter-clockwise, rad
///                   ╲l2        rates  ω = dθ/dt, rad/s
///                    ● m2 …    the pivot is the origin, x to the right, y up
template <class Scalar>
struct Pendulum {
    std::vector<Scalar> mass{1, 1};            // kg, > 0
    std::vector<Scalar> length{1, 1};          // m, > 0
    std::vector<Scalar> angle{0, 0};           // rad, at t = 0
    std::vector<Scalar> rate{0, 0};            // rad/s, at t = 0
    Scalar gravity = Scalar(98) / Scalar(10);  // m/s²

    std::size_t links() const { return mass.size(); }

    auto members() const { return std::tie(mass, length, angle, rate, gravity); }
    /// The same in another scalar.
    template <class To>
    Pendulum<To> cast() const {
        return Cast<To>()(*this);
    }

    /// Energy difference between hanging straight down and standing straight up, J: the scale of its energies.
    Scalar potential_range() const { return potential_range(length); }
    /// The same for rigid bodies with centres of mass at these distances from their joints, m.
    Scalar potential_range(const std::vector<Scalar>& center) const {
        Scalar range(0), reach(0);
        for (std::size_t i = 0; i < links(); ++i) {
            range += Scalar(2) * mass[i] * gravity * (reach + center[i]);
            reach += length[i];
        }
        return range;
    }

    /// From the pivot to the end of the outstretched chain, m.
    Scalar reach() const {
        Scalar sum(0);
        for (const auto& l : length) sum += l;
        return sum;
    }
};

/// (θ1 … θN, ω1 … ωN) at the release.
template <class Scalar, int N>
State<Scalar, times<2, N>> released_in_angles(const Pendulum<Scalar>& p) {
    const auto n = static_cast<Eigen::Index>(p.links());
    State<Scalar, times<2, N>> y(2 * n);
    std::copy(p.angle.begin(), p.angle.end(), y.data());
    std::copy(p.rate.begin(), p.rate.end(), y.data() + n);
    return y;
}

/// The energy of a release above the hanging equilibrium, J.
///     Σ ½ m v² + m g (l1 (1 − cosθ1) + l2 (1 − cosθ2) + …) ,
/// whose terms do not cancel as potential energies do.
inline double released_energy(const Pendulum<double>& p) {
    double vx = 0, vy = 0, height = 0, sum = 0;
    for (std::size_t i = 0; i < p.links(); ++i) {
        const double l = p.length[i], half = SinCos<double>(p.angle[i] / 2).sin;
        const SinCos<double> turn(p.angle[i]);
        vx += l * p.rate[i] * turn.cos;
        vy += l * p.rate[i] * turn.sin;
        height += 2 * l * half * half;
        sum += p.mass[i] * ((vx * vx + vy * vy) / 2 + p.gravity * height);
    }
    return sum;
}

}  // namespace doppel

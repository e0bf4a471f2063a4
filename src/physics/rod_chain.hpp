#pragma once

#include "numeric/state.hpp"
#include "physics/pendulum.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace doppel {

/// The double pendulum as two free particles that constraints hold on their rods (force-based dynamics).
///
///     C1 = ½ (|q1|² − l1²) = 0,   C2 = ½ (|q2 − q1|² − l2²) = 0
///
/// The multipliers λ of the constraint forces Jᵀλ follow from C″ = 0, as (J M⁻¹ Jᵀ) λ = −J̇ q̇ − J M⁻¹ F. Nothing pulls
/// the rods back once a method has let them stretch; length_error() says how far they have.
///
/// State   (x1, y1, x2, y2, vx1, vy1, vx2, vy2), m and m/s.
/// Source  Witkin 1997, Physically Based Modeling: Constrained Dynamics.
template <class Scalar>
struct RodChain {
    using State = doppel::State<Scalar, 8>;
    using Vector = Eigen::Matrix<Scalar, 2, 1>;

    Scalar m1, m2;  // kg
    Scalar w1, w2;  // 1/kg, their inverses: the diagonal of M⁻¹
    Scalar l1, l2;  // m
    Scalar g;       // m/s²

    explicit RodChain(const Pendulum& p)
        : m1(p.mass[0]),
          m2(p.mass[1]),
          w1(Scalar(1) / m1),
          w2(Scalar(1) / m2),
          l1(p.length[0]),
          l2(p.length[1]),
          g(p.gravity) {}

    static State start(const Pendulum& p) {
        using std::cos;
        using std::sin;
        const SinCos<Scalar> one{Scalar(p.angle[0])}, two{Scalar(p.angle[1])};
        const Vector q1(p.length[0] * one.sin, -p.length[0] * one.cos);
        const Vector q2(q1.x() + p.length[1] * two.sin, q1.y() - p.length[1] * two.cos);
        const Vector v1(p.length[0] * p.rate[0] * one.cos, p.length[0] * p.rate[0] * one.sin);
        const Vector v2(v1.x() + p.length[1] * p.rate[1] * two.cos, v1.y() + p.length[1] * p.rate[1] * two.sin);
        State y;
        y << q1, q2, v1, v2;
        return y;
    }

    /// d/dt of the state. With r1 = q1, r2 = q2 − q1 and u their rates, J has the rows (r1, 0) and (−r2, r2), so
    ///     ⎡ r1·r1/m1    −r1·r2/m1             ⎤ ⎡λ1⎤   ⎡ −u1·u1 + g r1y ⎤
    ///     ⎣ −r1·r2/m1    r2·r2 (1/m1 + 1/m2)  ⎦ ⎣λ2⎦ = ⎣ −u2·u2         ⎦
    /// (both masses fall alike, so gravity drops out of the second row).
    State rate(const State& y) const {
        const Scalar r1x = y[0], r1y = y[1], r2x = y[2] - y[0], r2y = y[3] - y[1];
        const Scalar v1x = y[4], v1y = y[5], u2x = y[6] - y[4], u2y = y[7] - y[5];

        const Scalar a11 = (r1x * r1x + r1y * r1y) * w1, a12 = -(r1x * r2x + r1y * r2y) * w1;
        const Scalar a22 = (r2x * r2x + r2y * r2y) * (w1 + w2);
        const Scalar b1 = g * r1y - (v1x * v1x + v1y * v1y), b2 = -(u2x * u2x + u2y * u2y);
        const Scalar inverse = Scalar(1) / (a11 * a22 - a12 * a12);
        const Scalar lambda1 = (b1 * a22 - b2 * a12) * inverse, lambda2 = (b2 * a11 - b1 * a12) * inverse;

        State rate;
        rate << v1x, v1y, y[6], y[7],                  //
            w1 * (lambda1 * r1x - lambda2 * r2x),      //
            w1 * (lambda1 * r1y - lambda2 * r2y) - g,  //
            w2 * lambda2 * r2x, w2 * lambda2 * r2y - g;
        return rate;
    }

    Bobs<Scalar> bobs(const State& y) const {
        const Vector r1 = y.template segment<2>(0), r2 = y.template segment<2>(2) - r1;
        const Vector v1 = y.template segment<2>(4), u2 = y.template segment<2>(6) - v1;
        return {{{m1, y[0], y[1], y[4], y[5], angle(r1), turning(r1, v1)},
                 {m2, y[2], y[3], y[6], y[7], angle(r2), turning(r2, u2)}}};
    }

    /// The rod that is furthest from its length, m.
    Scalar length_error(const State& y) const {
        using std::abs;
        const Vector r1 = y.template segment<2>(0), r2 = y.template segment<2>(2) - r1;
        return std::max<Scalar>(abs(r1.norm() - l1), abs(r2.norm() - l2));
    }

private:
    /// From the downward vertical, within (−π, π].
    static Scalar angle(const Vector& r) {
        using std::atan2;
        return atan2(r.x(), -r.y());
    }
    static Scalar turning(const Vector& r, const Vector& u) { return (r.x() * u.y() - r.y() * u.x()) / r.dot(r); }
};

}  // namespace doppel

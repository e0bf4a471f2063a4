#pragma once

#include "numeric/state.hpp"
#include "physics/pendulum.hpp"

namespace doppel {

/// The double pendulum in angles (Lagrange): two point masses on massless rigid rods, swinging in a vertical plane
/// without friction. Rods keep their length by construction.
///
/// State   (θ1, θ2, ω1, ω2). Angles are not wrapped: whole turns count as flips.
/// Source  Landau & Lifshitz, Mechanics, §5 problem 1, solved for the accelerations.
template <class S>
struct DoublePendulum {
    using Scalar = S;
    using State = doppel::State<Scalar, 4>;

    Scalar m1, m2;  // kg
    Scalar l1, l2;  // m
    Scalar g;       // m/s²

    explicit DoublePendulum(const Pendulum<Scalar>& p)
        : m1(p.mass[0]), m2(p.mass[1]), l1(p.length[0]), l2(p.length[1]), g(p.gravity) {}

    static State start(const Pendulum<Scalar>& p) { return released_in_angles<Scalar, 2>(p); }

    /// dydt ← d/dt of the state. With D = θ1 − θ2 and n = m1 + m2 sin²D:
    ///     θ1″ = [ −m2 sinD (l2 ω2² + l1 ω1² cosD) − g ((m1 + m2) sinθ1 − m2 cosD sinθ2) ] / (l1 n)
    ///     θ2″ = [ sinD ((m1 + m2) l1 ω1² + m2 l2 ω2² cosD) + (m1 + m2) g (sinθ1 cosD − sinθ2) ] / (l2 n)
    void rate(const State& y, State& dydt) const {
        const Scalar &w1 = y[2], &w2 = y[3];
        const SinCos<Scalar> one(y[0]), two(y[1]);
        const Scalar sin_d = one.sin * two.cos - one.cos * two.sin;
        const Scalar cos_d = one.cos * two.cos + one.sin * two.sin;
        const Scalar m = m1 + m2;
        const Scalar n = m1 + m2 * sin_d * sin_d;
        const Scalar pull1 = l1 * w1 * w1, pull2 = l2 * w2 * w2;
        const Scalar a1 = (-m2 * sin_d * (pull2 + pull1 * cos_d) - g * (m * one.sin - m2 * cos_d * two.sin)) / (l1 * n);
        const Scalar a2 = (sin_d * (m * pull1 + m2 * pull2 * cos_d) + m * g * (one.sin * cos_d - two.sin)) / (l2 * n);
        dydt << w1, w2, a1, a2;
    }
};

}  // namespace doppel

#pragma once

#include "numeric/compensated.hpp"
#include "numeric/solvers.hpp"
#include "physics/bob.hpp"
#include "physics/rod_multipliers.hpp"

#include <cmath>
#include <limits>
#include <vector>

namespace doppel {

/// N particles held by constraints on the rods of a chain (force-based dynamics).
///
///     C_k = ½ (|r_k|² − l_k²) = 0,   r_k = q_k − q_{k−1},   q_0 = the pivot
///
/// The multipliers λ of the constraint forces Jᵀλ follow from C″ = 0, as (J M⁻¹ Jᵀ) λ = −J̇ q̇ − J M⁻¹ F: for a chain a
/// tridiagonal system, O(N). The drift of a method from the rod lengths is not corrected (stabilise = "none").
///
/// State   (x1, y1 … xN, yN, vx1, vy1 … vxN, vyN), m and m/s.
/// Source  Witkin 1997, Physically Based Modeling: Constrained Dynamics.
template <class S, int N>
struct RodChain {
    using Scalar = S;
    using State = doppel::State<Scalar, is_lanes<Scalar> ? times<4, N> : Eigen::Dynamic>;
    using Half = doppel::State<Scalar, times<2, N>>;  // positions, velocities or accelerations
    using Multipliers = doppel::State<Scalar, N>;     // one for each rod

    Pendulum<Scalar> pendulum;
    Multipliers w;   // 1/kg, inverse masses: the diagonal of M⁻¹
    Multipliers l2;  // m², squared lengths
    Scalar g;        // m/s²

    explicit RodChain(const Pendulum<Scalar>& p)
        : pendulum(p),
          w(Multipliers::Zero(rows(p))),
          l2(w),
          g(p.gravity),
          matrix_(rows(p)),
          lambda_(w),
          squares_(w),
          crosses_(w),
          products_(w) {
        for (Eigen::Index k = 0; k < w.size(); ++k) {
            const auto i = static_cast<std::size_t>(k);
            w[k] = Scalar(1) / p.mass[i];
            l2[k] = p.length[i] * p.length[i];
        }
        if constexpr (N == 2 || N == 3) {
            multipliers_ = RodMultipliers<Scalar>(w, g);
            by_rho2_ = w[0] / w[1];
            const Scalar never(std::numeric_limits<double>::infinity());
            for (Eigen::Index k = 0; k + 1 < N; ++k)
                min_motion_ = select(w[k + 1] * Scalar(8) < w[k], never, min_motion_);
        }
    }

    static State start(const Pendulum<Scalar>& p) { return released_as_particles<Scalar, N>(p); }

    /// dydt ← d/dt of the state. With u_k = r_k′ the system for λ has the rows
    ///     −r_{k−1}·r_k λ_{k−1} / m_{k−1} + r_k·r_k (1/m_{k−1} + 1/m_k) λ_k − r_k·r_{k+1} λ_{k+1} / m_k
    ///         = −u_k·u_k + [k = 1] g r_1y
    /// (all masses have the same free-fall acceleration, so gravity cancels in all rows but the first).
    void rate(const State& y, State& dydt) {
        if constexpr (N == 2 || N == 3)
            rate_of_few(y, dydt);
        else
            rate_of_any(y, dydt);
    }

    /// The rod tensions from the pivot down, N, > 0 if a rod pulls: λ_k r_k acts on particle k, so T_k = −λ_k |r_k|.
    std::vector<Scalar> tensions(const State& y) {
        using std::sqrt;
        find_multipliers(y.head(2 * w.size()), y.tail(2 * w.size()));
        std::vector<Scalar> all;
        for (Eigen::Index k = 0; k < w.size(); ++k) all.push_back(-lambda_[k] * sqrt(square(y, k)));
        return all;
    }

    // Of the concept Constrained.

    Eigen::Index constraints() const { return w.size(); }
    bool depends_on_velocity() const { return false; }
    void free_acceleration(const Half&, const Half&, Half& a) const {
        a.setZero();
        for (Eigen::Index k = 0; k < w.size(); ++k) a[2 * k + 1] = -g;
    }
    void residual(const Half& q, Multipliers& c) const {
        for (Eigen::Index k = 0; k < w.size(); ++k) c[k] = (square(q, k) - l2[k]) * Scalar(0.5);
    }
    void rounding(const Half& q, Multipliers& c) const {
        using std::abs;
        const Scalar unit = Scalar(std::numeric_limits<Scalar>::epsilon()) * q.cwiseAbs().maxCoeff();
        for (Eigen::Index k = 0; k < w.size(); ++k) {
            const Scalar part = abs(along(q, k, 0)) + abs(along(q, k, 1));
            c[k] = (k == 0 ? part : Scalar(part + part)) * unit;
        }
    }
    void constraint_velocity(const Half& q, const Half& v, Multipliers& s) const {
        for (Eigen::Index k = 0; k < w.size(); ++k)
            s[k] = along(q, k, 0) * along(v, k, 0) + along(q, k, 1) * along(v, k, 1);
    }
    void jdot_v(const Half&, const Half& v, Multipliers& s) const {
        for (Eigen::Index k = 0; k < w.size(); ++k) s[k] = square(v, k);
    }
    void apply_multipliers(const Half& q, const Multipliers& lambda, Half& v) const {
        for (Eigen::Index k = 0; k < w.size(); ++k)
            for (Eigen::Index axis = 0; axis < 2; ++axis) {
                Scalar force = lambda[k] * along(q, k, axis);
                if (k + 1 < w.size()) force -= lambda[k + 1] * along(q, k + 1, axis);
                v[2 * k + axis] += w[k] * force;
            }
    }
    void solve(const Half& q1, const Half& q0, Multipliers& x) {
        factor(q1, q0);
        matrix_.solve(x);
    }

private:
    static Eigen::Index rows(const Pendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.links()); }

    /// Component `axis` of particle k minus that of the previous one.
    template <class Vector>
    static Scalar along(const Vector& q, Eigen::Index k, Eigen::Index axis) {
        return k == 0 ? Scalar(q[axis]) : Scalar(q[2 * k + axis] - q[2 * k - 2 + axis]);
    }
    template <class Vector>
    static Scalar square(const Vector& q, Eigen::Index k) {
        const Scalar x = along(q, k, 0), y = along(q, k, 1);
        return x * x + y * y;
    }

    /// r_k × r_{k+1}, to full precision even if the rods are nearly aligned.
    template <class Vector>
    static Scalar cross(const Vector& q, Eigen::Index k) {
        const auto rod = [&](Eigen::Index of, Eigen::Index axis) {
            return of == 0 ? Compensated<Scalar>{q[axis], Scalar(0)}
                           : exact_difference<Scalar>(q[2 * of + axis], q[2 * of - 2 + axis]);
        };
        const auto x = rod(k, 0), y = rod(k, 1), next_x = rod(k + 1, 0), next_y = rod(k + 1, 1);
        const auto plus = exact_product(x.value, next_y.value), minus = exact_product(y.value, next_x.value);
        const auto all = exact_difference(plus.value, minus.value);
        const Scalar rest =
            (x.value * next_y.rest + x.rest * next_y.value) - (y.value * next_x.rest + y.rest * next_x.value);
        return all.value + (all.rest + ((plus.rest - minus.rest) + rest));
    }

    void rate_of_any(const State& y, State& dydt) {
        const auto n = w.size();
        const auto q = y.head(2 * n), v = y.tail(2 * n);
        find_multipliers(q, v);
        dydt.head(2 * n) = v;
        auto a = dydt.tail(2 * n);
        // r_k″ = α_k (rotated r_k) − (|u_k|² / |r_k|²) r_k: along a rod, the forces on a light mass would almost cancel
        Scalar x(0), y_up(0);
        for (Eigen::Index k = 0; k < n; ++k) {
            Scalar across = k == 0 ? Scalar(-(g * q[0])) : Scalar(crosses_[k - 1] * lambda_[k - 1]);
            if (k + 1 < n) across -= crosses_[k] * lambda_[k + 1];
            const Scalar by_square = Scalar(1) / squares_[k];
            const Scalar alpha = across * by_square, beta = square(v, k) * by_square;
            x -= alpha * along(q, k, 1) + beta * along(q, k, 0);
            y_up += alpha * along(q, k, 0) - beta * along(q, k, 1);
            a[2 * k] = x;
            a[2 * k + 1] = y_up;
        }
    }

    void rate_of_few(const State& y, State& dydt) {
        Planar<Scalar> r[N], u[N], p[N];
        for (Eigen::Index k = 0; k < N; ++k) {
            r[k] = {along(y, k, 0), along(y, k, 1)};
            u[k] = {along(y, k, 2 * N), along(y, k, 2 * N + 1)};
        }
        if constexpr (N == 3) {
            r[2] = r[2] * by_rho2_;
            u[2] = u[2] * by_rho2_;
        }
        multipliers_.find(r, u, p);
        dydt.head(2 * N) = y.tail(2 * N);
        auto a = dydt.tail(2 * N);
        a[0] = p[0].x - p[1].x;
        a[1] = (p[0].y - p[1].y) - g;
        a[2] = p[1].x * multipliers_.rho2;
        a[3] = p[1].y * multipliers_.rho2;
        if constexpr (N == 3) {
            a[2] -= p[2].x;
            a[3] -= p[2].y;
            a[4] = p[2].x * multipliers_.below;
            a[5] = p[2].y * multipliers_.below - g;
        }
        a[3] -= g;

        Scalar motion(0);
        for (const auto& rate : u) motion += dot(rate, rate);
        const auto moves = motion > min_motion_;
        if (!all_of(moves)) [[unlikely]]
            compute_with_equilibria(moves, y, dydt);
    }
    /// In equilibrium these sums are exactly zero; they also keep the digits of a light mass.
    template <class Mask>
    [[gnu::noinline]] void compute_with_equilibria(const Mask& moves, const State& y, State& dydt) {
        State careful = dydt;
        rate_of_any(y, careful);
        for (Eigen::Index i = 0; i < y.size(); ++i) dydt[i] = select(moves, dydt[i], careful[i]);
    }

    template <class Vector>
    void find_multipliers(const Vector& q, const Vector& v) {
        factor(q, q);
        for (Eigen::Index k = 0; k < w.size(); ++k) lambda_[k] = -square(v, k);
        lambda_[0] += g * q[1];
        matrix_.solve(lambda_);
    }

    /// J(q1) M⁻¹ Jᵀ(q0)
    template <class Vector>
    void factor(const Vector& q1, const Vector& q0) {
        const auto dot = [&](Eigen::Index one, Eigen::Index zero) {
            return along(q1, one, 0) * along(q0, zero, 0) + along(q1, one, 1) * along(q0, zero, 1);
        };
        const auto last = w.size() - 1;
        for (Eigen::Index k = 0; k <= last; ++k) {
            squares_[k] = dot(k, k);
            if (k == last) break;
            matrix_.upper[k] = -(dot(k, k + 1) * w[k]);
            matrix_.lower[k] = -(dot(k + 1, k) * w[k]);
            crosses_[k] = w[k] * cross(q1, k);
            products_[k] = crosses_[k] * (&q1 == &q0 ? crosses_[k] : Scalar(w[k] * cross(q0, k)));
        }
        const Scalar whole = last > 0 ? Scalar(w[last - 1] + w[last]) : w[last];
        matrix_.factor(
            w, [&](Eigen::Index k) { return squares_[k]; }, products_, Scalar(1) / Scalar(w[0] * squares_[0]),
            Scalar(1) / Scalar(whole * squares_[last]));
    }

    ChainMatrix<Scalar, N> matrix_;
    Multipliers lambda_;  // N/m
    Multipliers squares_, crosses_,
        products_;  // |r_k|², w_k r_k × r_{k+1}, its square (for RATTLE, from two positions)
    // for two or three rods
    RodMultipliers<Scalar> multipliers_;
    Scalar by_rho2_{1};
    // m²/s²: Σ |u_k|² above which multipliers_ is used; infinite if a mass is below 1/8 of the next
    Scalar min_motion_{0};
};

}  // namespace doppel

#pragma once

#include "numeric/solvers.hpp"
#include "numeric/state.hpp"
#include "physics/pendulum.hpp"

#include <array>

namespace doppel {

/// N point masses on N massless rigid rods, each hanging from the previous one (Lagrange). A step costs O(N): the
/// tensions T of the rods solve a tridiagonal system, and determine the angular accelerations.
///
/// With n_k = (sinθ_k, −cosθ_k) along rod k and t_k = (cosθ_k, sinθ_k) across it, Newton's law for bob k is
///     m_k q_k″ = −T_k n_k + T_{k+1} n_{k+1} + m_k g⃗ ,     q_k″ − q_{k−1}″ = l_k (θ_k″ t_k − ω_k² n_k).
/// The component along n_k does not contain θ″. With c_k = cos(θ_{k+1} − θ_k) and 1/m_0 = 0 it is
///     −c_{k−1} T_{k−1} / m_{k−1} + (1/m_{k−1} + 1/m_k) T_k − c_k T_{k+1} / m_k = l_k ω_k² + [k = 1] g cosθ_1,
/// and the component along t_k, with s_k = sin(θ_{k+1} − θ_k), is
///     l_k θ_k″ = T_{k+1} s_k / m_k − T_{k−1} s_{k−1} / m_{k−1} − [k = 1] g sinθ_1.
///
/// State   (θ1 … θN, ω1 … ωN). Angles are not wrapped.
/// Source  the same motion as M θ″ = f with M_ij = μ_max(i,j) l_i l_j cos(θ_i − θ_j), μ_k = Σ_{j≥k} m_j
///         (Yesilyurt 2019, arXiv:1910.12610), whose solution by elimination costs O(N³).
template <class S, int N>
struct AngleChain {
    using Scalar = S;
    using State = doppel::State<Scalar, times<2, N>>;
    using Half = doppel::State<Scalar, N>;
    using Angles = StageAngles<Scalar, N>;

    Pendulum<Scalar> pendulum;
    Half w;                  // 1/kg, inverse masses
    Half length, by_length;  // m, 1/m
    Half sin, cos;           // of θ_1 and the differences θ_k − θ_{k−1}, at the last update()
    Half s, c;               // of the angle between a rod and the next one, divided by the mass between them, 1/kg
    Half tension;            // N
    ChainMatrix<Scalar, N> matrix;

    explicit AngleChain(const Pendulum<Scalar>& p)
        : pendulum(p),
          w(Half::Zero(rows(p))),
          length(w),
          by_length(w),
          sin(w),
          cos(w),
          s(w),
          c(w),
          tension(w),
          matrix(rows(p)),
          turned_(w),
          squares_(w) {
        const auto n = w.size();
        for (Eigen::Index k = 0; k < n; ++k) {
            const auto i = static_cast<std::size_t>(k);
            w[k] = Scalar(1) / p.mass[i];
            length[k] = p.length[i];
            by_length[k] = Scalar(1) / p.length[i];
        }
        by_last_ = Scalar(1) / (n > 1 ? Scalar(w[n - 2] + w[n - 1]) : w[0]);
    }

    static State start(const Pendulum<Scalar>& p) { return released_in_angles<Scalar, N>(p); }

    /// dydt ← d/dt of the state. `take` is TakeSinCos, or one of StageAngles.
    template <class Take = TakeSinCos>
    void rate(const State& y, State& dydt, const Take& take = {}) {
        take(turned(y), sin, cos);
        factor();
        rate_of_angles(y, dydt);
    }

    /// Computes everything that depends only on the angles, the first elements of `y`, and factors the matrix.
    template <class Y>
    void update(const Y& y) {
        TakeSinCos()(turned(y), sin, cos);
        factor();
    }

    /// a ← M⁻¹ f at the angles of the last update(), in O(N): accelerations from generalized forces f (N m), or rates
    /// from momenta f (N m s). P_k = Σ_{j≥k} m_j q_j″ has the component f_k / l_k across rod k and τ_k along it; τ
    /// solves the system of the tensions.
    void solve_mass(const Half& f, Half& a) {
        const auto n = w.size();
        const auto across = [&](Eigen::Index k) { return f[k] * by_length[k]; };
        for (Eigen::Index k = 0; k < n; ++k) {
            tension[k] = Scalar(0);
            if (k + 1 < n) tension[k] -= across(k + 1) * s[k];
            if (k > 0) tension[k] += across(k - 1) * s[k - 1];
        }
        matrix.solve(tension);
        for (Eigen::Index k = 0; k < n; ++k) {
            Scalar sum = across(k) * w[k];
            if (k + 1 < n) sum -= across(k + 1) * c[k] + tension[k + 1] * s[k];
            if (k > 0) sum += across(k) * w[k - 1] - across(k - 1) * c[k - 1] + tension[k - 1] * s[k - 1];
            a[k] = sum * by_length[k];
        }
    }

private:
    static Eigen::Index rows(const Pendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.links()); }

    /// The sine of a small angle difference is computed from the difference, to keep its digits.
    template <class Y>
    const Half& turned(const Y& y) {
        turned_[0] = y[0];
        for (Eigen::Index k = 1; k < w.size(); ++k) turned_[k] = y[k] - y[k - 1];
        return turned_;
    }

    /// Computes s, c and the factored matrix from sines and cosines.
    void factor() {
        const auto n = w.size();
        for (Eigen::Index k = 0; k + 1 < n; ++k) {
            s[k] = sin[k + 1] * w[k];
            c[k] = cos[k + 1] * w[k];
            matrix.upper[k] = matrix.lower[k] = -c[k];
            squares_[k] = s[k] * s[k];
        }
        matrix.factor(
            w, [](Eigen::Index) { return Scalar(1); }, squares_, pendulum.mass[0], by_last_);
    }

    void rate_of_angles(const State& y, State& dydt) {
        const auto n = w.size();
        for (Eigen::Index k = 0; k < n; ++k) tension[k] = length[k] * y[n + k] * y[n + k];
        tension[0] += pendulum.gravity * cos[0];
        matrix.solve(tension);
        for (Eigen::Index k = 0; k < n; ++k) {
            Scalar across = k == 0 ? Scalar(-(pendulum.gravity * sin[0])) : Scalar(-(tension[k - 1] * s[k - 1]));
            if (k + 1 < n) across += tension[k + 1] * s[k];
            dydt[k] = y[n + k];
            dydt[n + k] = across * by_length[k];
        }
    }

    Half turned_, squares_;  // the angles of `sin` and `cos`, rad; s², 1/kg²
    Scalar by_last_;         // inverse of the last diagonal element, kg; that of the first is m_1
};

/// The double pendulum in angles (Lagrange): two point masses on massless rigid rods, in a vertical plane, without
/// friction. The coordinates keep the rod lengths exactly.
///
/// State   (θ1, θ2, ω1, ω2). Angles are not wrapped: whole turns count as flips.
/// Source  Landau & Lifshitz, Mechanics, §5 problem 1, solved for the accelerations.
template <class S>
struct DoublePendulum {
    using Scalar = S;
    using State = doppel::State<Scalar, compiled_size<Scalar, 4>>;
    using Angles = StageAngles<Scalar, 2>;

    Scalar m1, m2;  // kg
    Scalar l1, l2;  // m
    Scalar g;       // m/s²

    explicit DoublePendulum(const Pendulum<Scalar>& p)
        : m1(p.mass[0]),
          m2(p.mass[1]),
          l1(p.length[0]),
          l2(p.length[1]),
          g(p.gravity),
          mass_ratio_(m1 / m2),
          length_ratio_(l2 / l1),
          lever_((m1 + m2) / (m2 * length_ratio_)),
          gravity_by_length_(g / l1) {}

    static State start(const Pendulum<Scalar>& p) { return released_in_angles<Scalar, 2>(p); }

    /// dydt ← d/dt of the state. With D = θ2 − θ1, L = l2/l1, μ = m1/m2 and q = ω1² + (g/l1) cosθ1:
    ///     θ1″ =  (q cosD + L ω2²) f − (g/l1) sinθ1
    ///     θ2″ = −(q (1 + μ) / L + ω2² cosD) f,      f = sinD / (μ + sin²D)
    /// `take` is TakeSinCos, or one of StageAngles.
    template <class Take = TakeSinCos>
    void rate(const State& y, State& dydt, const Take& take = {}) const {
        doppel::State<Scalar, 2> sin, cos;
        take(std::array{y[0], Scalar(y[1] - y[0])}, sin, cos);
        const Scalar square1 = y[2] * y[2], square2 = y[3] * y[3];
        const Scalar f = sin[1] / (mass_ratio_ + sin[1] * sin[1]);
        const Scalar q = square1 + gravity_by_length_ * cos[0];
        const Scalar a1 = (q * cos[1] + length_ratio_ * square2) * f - gravity_by_length_ * sin[0];
        const Scalar a2 = -((q * lever_ + square2 * cos[1]) * f);
        dydt[0] = y[2];
        dydt[1] = y[3];
        dydt[2] = a1;
        dydt[3] = a2;
    }

private:
    Scalar mass_ratio_, length_ratio_;  // μ, L
    Scalar lever_;                      // (1 + μ) / L
    Scalar gravity_by_length_;          // g / l1, 1/s²
};

}  // namespace doppel

#pragma once

#include "numeric/tridiagonal.hpp"
#include "physics/pendulum.hpp"

namespace doppel {

/// N point masses on N massless rigid rods, each hanging below the one before (Lagrange). A step costs O(N): the
/// tensions T of the rods solve a tridiagonal system, and give the angles' accelerations.
///
/// With n_k = (sinθ_k, −cosθ_k) along rod k and t_k = (cosθ_k, sinθ_k) across it, Newton's law for bob k is
///     m_k q_k″ = −T_k n_k + T_{k+1} n_{k+1} + m_k g⃗ ,     q_k″ − q_{k−1}″ = l_k (θ_k″ t_k − ω_k² n_k).
/// Its part along n_k holds no θ″, which leaves, with c_k = cos(θ_{k+1} − θ_k) and 1/m_0 = 0,
///     −c_{k−1} T_{k−1} / m_{k−1} + (1/m_{k−1} + 1/m_k) T_k − c_k T_{k+1} / m_k = l_k ω_k² + [k = 1] g cosθ_1,
/// and its part along t_k, with s_k = sin(θ_{k+1} − θ_k),
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

    Pendulum<Scalar> pendulum;
    Half w;         // 1/kg, inverse masses
    Half sin, cos;  // of the angles last looked at
    Half s, c;      // of the angle between a rod and the next
    Half tension;   // N
    Tridiagonal<Scalar, N> matrix;

    explicit AngleChain(const Pendulum<Scalar>& p)
        : pendulum(p),
          w(rows(p)),
          sin(rows(p)),
          cos(rows(p)),
          s(rows(p)),
          c(rows(p)),
          tension(rows(p)),
          matrix(rows(p)) {
        for (Eigen::Index k = 0; k < w.size(); ++k) w[k] = Scalar(1) / p.mass[static_cast<std::size_t>(k)];
    }

    static State start(const Pendulum<Scalar>& p) { return released_in_angles<Scalar, N>(p); }

    /// dydt ← d/dt of the state.
    void rate(const State& y, State& dydt) {
        const auto n = w.size();
        look(y);
        for (Eigen::Index k = 0; k < n; ++k) tension[k] = length(k) * y[n + k] * y[n + k];
        tension[0] += pendulum.gravity * cos[0];
        matrix.solve(tension);
        for (Eigen::Index k = 0; k < n; ++k) {
            Scalar across(0);
            if (k + 1 < n) across += tension[k + 1] * s[k] * w[k];
            if (k > 0)
                across -= tension[k - 1] * s[k - 1] * w[k - 1];
            else
                across -= pendulum.gravity * sin[0];
            dydt[k] = y[n + k];
            dydt[n + k] = across / length(k);
        }
    }

    /// Looks at the angles that `y` begins with: what depends on them alone, the matrix factored.
    template <class Angles>
    void look(const Angles& y) {
        const auto n = w.size();
        for (Eigen::Index k = 0; k < n; ++k) {
            const SinCos<Scalar> turn(y[k]);
            sin[k] = turn.sin;
            cos[k] = turn.cos;
        }
        for (Eigen::Index k = 0; k + 1 < n; ++k) {
            s[k] = sin[k + 1] * cos[k] - cos[k + 1] * sin[k];
            c[k] = cos[k + 1] * cos[k] + sin[k + 1] * sin[k];
        }
        matrix.diagonal[0] = w[0];
        for (Eigen::Index k = 0; k + 1 < n; ++k) {
            matrix.diagonal[k + 1] = w[k] + w[k + 1];
            matrix.upper[k] = matrix.lower[k] = -(c[k] * w[k]);
        }
        matrix.factor();
    }

    /// a ← M⁻¹ f at the angles last looked at, in O(N): the accelerations that generalized forces f (N m) would cause,
    /// or the rates that belong to momenta f (N m s). P_k = Σ_{j≥k} m_j q_j″ is f_k / l_k across rod k and τ_k along
    /// it, and τ solves the system of the tensions.
    void solve_mass(const Half& f, Half& a) {
        const auto n = w.size();
        const auto across = [&](Eigen::Index k) { return f[k] / length(k); };
        for (Eigen::Index k = 0; k < n; ++k) {
            tension[k] = Scalar(0);
            if (k + 1 < n) tension[k] -= across(k + 1) * s[k] * w[k];
            if (k > 0) tension[k] += across(k - 1) * s[k - 1] * w[k - 1];
        }
        matrix.solve(tension);
        for (Eigen::Index k = 0; k < n; ++k) {
            Scalar sum = across(k) * w[k];
            if (k + 1 < n) sum -= (across(k + 1) * c[k] + tension[k + 1] * s[k]) * w[k];
            if (k > 0) sum += (across(k) - across(k - 1) * c[k - 1] + tension[k - 1] * s[k - 1]) * w[k - 1];
            a[k] = sum / length(k);
        }
    }

private:
    static Eigen::Index rows(const Pendulum<Scalar>& p) { return static_cast<Eigen::Index>(p.links()); }
    const Scalar& length(Eigen::Index k) const { return pendulum.length[static_cast<std::size_t>(k)]; }
};

}  // namespace doppel

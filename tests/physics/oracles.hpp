#pragma once

#include "physics/bob.hpp"
#include "physics/physical_chain.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

namespace doppel {

/// Of the bodies at y, whose pivot may move.
template <class Scalar>
Energies<Scalar> energies_at(const PhysicalPendulum<Scalar>& p, const PhysicalChain<Scalar>& model,
                             const typename PhysicalChain<Scalar>::State& y) {
    const PivotPlace<Scalar> pivot(p.pivot, model.layout.time_of(y));
    const auto &place = pivot.place, &velocity = pivot.velocity;
    auto bobs = bobs_of_angles<Scalar>(p.chain, model.layout.of_links(y));
    for (auto& bob : bobs) bob.x += place.x, bob.y += place.y, bob.vx += velocity.x, bob.vy += velocity.y;
    return energies(p, bobs, {Scalar(0), place.x, place.y, velocity.x, velocity.y});
}

/// θ″ of bodies without friction or drive, from Lagrange's equations M θ″ = f solved by elimination: another way to every
/// model's accelerations. M_ij = K_ij cos(θ_i − θ_j), f_i = −Σ K_ij sin(θ_i − θ_j) ω_j² − g S_i sinθ_i, with
/// S_i = m_i a_i + l_i Σ_{k>i} m_k, K_ij = l_i S_j (i < j), K_ii = I_i + m_i a_i² + l_i² Σ_{k>i} m_k.
inline Eigen::VectorXd by_elimination(const PhysicalPendulum<double>& p) {
    const auto n = static_cast<Eigen::Index>(p.chain.links());
    Eigen::MatrixXd k(n, n), m(n, n);
    Eigen::VectorXd s(n), f(n);
    double below = 0;
    for (Eigen::Index i = n - 1; i >= 0; --i) {
        const auto u = static_cast<std::size_t>(i);
        const double mass = p.chain.mass[u], length = p.chain.length[u], center = p.center[u];
        s[i] = mass * center + length * below;
        k(i, i) = p.inertia[u] + mass * center * center + length * length * below;
        below += mass;
    }
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = i + 1; j < n; ++j) k(i, j) = k(j, i) = p.chain.length[static_cast<std::size_t>(i)] * s[j];
    for (Eigen::Index i = 0; i < n; ++i) {
        const double angle = p.chain.angle[static_cast<std::size_t>(i)];
        f[i] = -p.chain.gravity * s[i] * std::sin(angle);
        for (Eigen::Index j = 0; j < n; ++j) {
            const auto v = static_cast<std::size_t>(j);
            const double apart = angle - p.chain.angle[v];
            m(i, j) = k(i, j) * std::cos(apart);
            f[i] -= k(i, j) * std::sin(apart) * p.chain.rate[v] * p.chain.rate[v];
        }
    }
    return m.ldlt().solve(f);
}

/// q_k″ = Σ_{j≤k} l_j (θ_j″ (cos, sin) + ω_j² (−sin, cos)) of the bobs of a chain, by elimination.
inline std::vector<Eigen::Vector2d> accelerations_of_bobs(const Pendulum<double>& p) {
    const auto alpha = by_elimination(physical(p));
    std::vector<Eigen::Vector2d> all;
    Eigen::Vector2d sum(0, 0);
    for (std::size_t k = 0; k < p.links(); ++k) {
        const double sin = std::sin(p.angle[k]), cos = std::cos(p.angle[k]), w2 = p.rate[k] * p.rate[k];
        sum += p.length[k] * Eigen::Vector2d(alpha[static_cast<long>(k)] * cos - w2 * sin,
                                             alpha[static_cast<long>(k)] * sin + w2 * cos);
        all.push_back(sum);
    }
    return all;
}

}  // namespace doppel

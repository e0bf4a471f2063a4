#pragma once

#include "physics/bob.hpp"
#include "physics/physical_chain.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

namespace doppel {

/// The rates of the state at the start.
template <class Model, class Description>
typename Model::State rate_at_start(const Description& description) {
    Model model(description);
    const typename Model::State y = Model::start(description);
    auto rate = y;
    model.rate(y, rate);
    return rate;
}

/// Lagrange's equations of rigid bodies: M_ij = K_ij cos(θ_i − θ_j), with S_i = m_i a_i + l_i Σ_{k>i} m_k,
/// K_ij = l_i S_j (i < j), K_ii = I_i + m_i a_i² + l_i² Σ_{k>i} m_k.
struct Lagrange {
    Eigen::MatrixXd k;
    Eigen::VectorXd s;

    explicit Lagrange(const PhysicalPendulum<double>& p)
        : k(p.chain.links(), p.chain.links()), s(static_cast<Eigen::Index>(p.chain.links())) {
        double below = 0;
        for (Eigen::Index i = s.size() - 1; i >= 0; --i) {
            const auto u = static_cast<std::size_t>(i);
            const double mass = p.chain.mass[u], length = p.chain.length[u], center = p.center[u];
            s[i] = mass * center + length * below;
            k(i, i) = p.inertia[u] + mass * center * center + length * length * below;
            for (Eigen::Index j = 0; j < i; ++j) k(i, j) = k(j, i) = p.chain.length[static_cast<std::size_t>(j)] * s[i];
            below += mass;
        }
    }
    Eigen::MatrixXd mass(const Eigen::VectorXd& theta) const {
        Eigen::MatrixXd m = k;
        for (Eigen::Index i = 0; i < s.size(); ++i)
            for (Eigen::Index j = 0; j < s.size(); ++j) m(i, j) *= std::cos(theta[i] - theta[j]);
        return m;
    }
};

/// θ″ of bodies without friction or drive by elimination, M θ″ = f: independent of the models' computation.
/// f_i = −Σ K_ij sin(θ_i − θ_j) ω_j² − g S_i sinθ_i.
inline Eigen::VectorXd by_elimination(const PhysicalPendulum<double>& p) {
    const Lagrange lagrange(p);
    const auto n = lagrange.s.size();
    const Eigen::VectorXd theta = Eigen::VectorXd::Map(p.chain.angle.data(), n);
    Eigen::VectorXd f(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        f[i] = -p.chain.gravity * lagrange.s[i] * std::sin(theta[i]);
        for (Eigen::Index j = 0; j < n; ++j) {
            const double rate = p.chain.rate[static_cast<std::size_t>(j)];
            f[i] -= lagrange.k(i, j) * std::sin(theta[i] - theta[j]) * rate * rate;
        }
    }
    return lagrange.mass(theta).ldlt().solve(f);
}

/// q_k″ = Σ_{j≤k} l_j (θ_j″ (cos, sin) + ω_j² (−sin, cos)) of the bobs of a chain, with θ″ by elimination.
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

#pragma once

#include "integrate/stabilise.hpp"
#include "integrate/taylor_series.hpp"
#include "physics/rod_chain.hpp"

#include <cmath>
#include <vector>

namespace doppel {

/// The Taylor series of a chain of particles on rods, from products of series alone. With r_i = q_i − q_{i−1} the
/// equations are products only:
///     q_i″ = −g ŷ + (λ_i r_i − λ_{i+1} r_{i+1}) / m_i ,    |r_i|² constant.
/// Coefficient k + 2 of the second, with r_{i,k+2} = A_{i,k} / ((k + 1)(k + 2)) and A = q_i″ − q_{i−1}″, is
///     r_0 · A_k = −½ (k + 1)(k + 2) Σ_{j=1}^{k+1} r_j · r_{k+2−j} ,
/// a tridiagonal system for λ_k, with the same matrix at every order.
/// Lengths are what they are in the state: nothing pulls the rods back.
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
///         The motion: that of RodChain.
template <class S, int N>
class RodSeries {
public:
    using Scalar = S;
    using Model = RodChain<Scalar, N>;
    using State = typename Model::State;

    RodSeries(const Model& model, int order)
        : order_(order),
          links_(model.w.size()),
          w_(model.w),
          g_(model.g),
          rods_(static_cast<std::size_t>(order + 2), Half::Zero(2 * links_)),
          rates_(static_cast<std::size_t>(order + 1), rods_[0]),
          lambda_(static_cast<std::size_t>(order), Multipliers::Zero(links_)),
          pull_(rods_[0]),
          matrix_(links_) {
        using std::sqrt;
        Scalar sum(0);
        for (Eigen::Index i = 0; i < links_; ++i) sum += sqrt(model.l2[i]);
        reach_ = plain_value(sum);
    }

    void expand(const State& y) {
        for (Eigen::Index c = 0; c < 2 * links_; ++c) {
            rates_[0][c] = y[2 * links_ + c];
            rods_[0][c] = relative(y, c);
            rods_[1][c] = relative(rates_[0], c);
        }
        for (Eigen::Index i = 0; i < links_; ++i) {
            matrix_.diagonal[i] = dot(0, i, 0, i) * (i == 0 ? w_[0] : Scalar(w_[i - 1] + w_[i]));
            if (i + 1 < links_) matrix_.upper[i] = matrix_.lower[i] = -(dot(0, i, 0, i + 1) * w_[i]);
        }
        matrix_.factor();
        for (int k = 0; k < order_; ++k) next(k);
        amount_ = greatest(0) + std::sqrt(greatest(1) * reach_);
    }

    void move(const Scalar& h, State& change) const {
        for (Eigen::Index c = 0; c < 2 * links_; ++c) {
            Scalar place(0), rate(0);
            for (int k = order_; k > 0; --k) {
                const Scalar& v = rates_[static_cast<std::size_t>(k)][c];
                place = (place + v / Scalar(k + 1)) * h;
                rate = (rate + v) * h;
            }
            change[c] = (place + rates_[0][c]) * h;
            change[2 * links_ + c] = rate;
        }
    }

    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }

    double longest_step() const { return longest_chain_step(reach_, plain_value(g_)); }

private:
    using Half = typename Model::Half;
    using Multipliers = typename Model::Multipliers;

    /// λ_k, q′_{k+1} and r_{k+2} from all before.
    void next(int k) {
        Multipliers& lambda = lambda_[static_cast<std::size_t>(k)];
        Half& rates = rates_[static_cast<std::size_t>(k + 1)];
        pull_.setConstant(Scalar(0));
        for (int j = 1; j <= k; ++j) add_pull(j, k - j);
        accelerate(k);

        const Scalar factor = Scalar((k + 1) * (k + 2)) / Scalar(2);
        for (Eigen::Index i = 0; i < links_; ++i) {
            Scalar sum(0), along(0);
            for (int j = 1; j <= k + 1; ++j) sum += dot(j, i, k + 2 - j, i);
            for (Eigen::Index c = 2 * i; c < 2 * i + 2; ++c) along += rods_[0][c] * relative(rates, c);
            lambda[i] = -(along + factor * sum);
        }
        matrix_.solve(lambda);

        add_pull(0, k);
        accelerate(k);
        if (k + 1 < order_) {
            auto& rods = rods_[static_cast<std::size_t>(k + 2)];
            for (Eigen::Index c = 0; c < 2 * links_; ++c) rods[c] = relative(rates, c) / Scalar((k + 1) * (k + 2));
        }
        rates /= Scalar(k + 1);
    }

    /// pull ← pull + r_j λ_k, each rod on the particle below it
    void add_pull(int j, int k) {
        const auto& r = rods_[static_cast<std::size_t>(j)];
        const auto& lambda = lambda_[static_cast<std::size_t>(k)];
        for (Eigen::Index c = 0; c < 2 * links_; ++c) pull_[c] += r[c] * lambda[c / 2];
    }

    /// q″_k from the pulls of the rods, where q′_{k+1} will be
    void accelerate(int k) {
        auto& a = rates_[static_cast<std::size_t>(k + 1)];
        for (Eigen::Index c = 0; c < 2 * links_; ++c) {
            Scalar force = pull_[c];
            if (c + 2 < 2 * links_) force -= pull_[c + 2];
            a[c] = w_[c / 2] * force;
            if (k == 0 && c % 2 == 1) a[c] -= g_;
        }
    }

    /// Component c of what a particle has more than the one above it.
    template <class Vector>
    static Scalar relative(const Vector& v, Eigen::Index c) {
        return c < 2 ? v[c] : Scalar(v[c] - v[c - 2]);
    }

    Scalar dot(int j, Eigen::Index a, int k, Eigen::Index b) const {
        const auto &one = rods_[static_cast<std::size_t>(j)], &other = rods_[static_cast<std::size_t>(k)];
        return one[2 * a] * other[2 * b] + one[2 * a + 1] * other[2 * b + 1];
    }

    /// The greatest coefficient k of the velocities, m/s^(k+1).
    double greatest(int k) const {
        double most = 0;
        for (const Scalar& rate : rates_[static_cast<std::size_t>(k)])
            most = greater(most, std::abs(plain_value(rate)));
        return most;
    }

    int order_;
    Eigen::Index links_;
    Multipliers w_;
    Scalar g_;
    double reach_ = 0;                 // m
    std::vector<Half> rods_;           // r_k, order by order
    std::vector<Half> rates_;          // q′_k
    std::vector<Multipliers> lambda_;  // λ_k
    Half pull_;
    Tridiagonal<Scalar, N> matrix_;
    double amount_ = 0;  // of the velocities, m/s
};

template <class Scalar, int N>
struct SeriesOf<RodChain<Scalar, N>> {
    using type = RodSeries<Scalar, N>;
};

/// Projected after every step, the motion is the same.
template <HasSeries Model>
struct SeriesOf<Projected<Model>> : SeriesOf<Model> {};

}  // namespace doppel

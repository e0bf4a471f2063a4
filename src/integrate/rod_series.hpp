#pragma once

#include "integrate/rod_bundle.hpp"
#include "integrate/stabilise.hpp"
#include "integrate/taylor_series.hpp"
#include "numeric/subnormals.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
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
          rods_(Half::Zero(2 * links_)),
          products_(order, static_cast<std::size_t>(links_)),
          rates_(static_cast<std::size_t>(order + 1), rods_),
          lambda_(Multipliers::Zero(links_)),
          pull_(rods_),
          matrix_(links_) {
        for (int k = 1; k < order + 3; ++k) inverse_.push_back(Scalar(1) / Scalar(k));
        using std::sqrt;
        Scalar sum(0);
        for (Eigen::Index i = 0; i < links_; ++i) sum += sqrt(model.l2[i]);
        reach_ = plain_value(sum);
    }

    void expand(const State& y) {
        const NoSubnormals here;
        rates_[0] = y.tail(2 * links_);
        for (Eigen::Index c = 0; c < 2 * links_; ++c) rods_[c] = relative(y, c);
        set_rods(1, rates_[0], Scalar(1));
        for (Eigen::Index i = 0; i < links_; ++i) {
            matrix_.diagonal[i] = dot(i, i) * (i == 0 ? w_[0] : Scalar(w_[i - 1] + w_[i]));
            if (i + 1 < links_) matrix_.upper[i] = matrix_.lower[i] = -(dot(i, i + 1) * w_[i]);
        }
        matrix_.factor();
        for (int k = 0; k < order_; ++k) next(k);
        amount_ = greatest(0) + std::sqrt(greatest(1) * reach_);
    }

    void move(const Scalar& h, State& change) const {
        const NoSubnormals here;
        const Eigen::Index n = 2 * links_, some = 64;  // a few components at a time: they stay in the cache
        for (Eigen::Index first = 0; first < n; first += some) {
            const auto size = std::min(some, n - first);
            auto place = change.segment(first, size), rate = change.segment(n + first, size);
            place.setZero();
            rate.setZero();
            for (int k = order_; k > 0; --k) {
                const auto v = rates_[static_cast<std::size_t>(k)].segment(first, size);
                place = (place + v * inverse(k + 1)) * h;
                rate = (rate + v) * h;
            }
            place = (place + rates_[0].segment(first, size)) * h;
        }
    }

    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }

    double longest_step() const { return longest_chain_step(reach_, plain_value(g_)); }

private:
    using Half = typename Model::Half;
    using Multipliers = typename Model::Multipliers;

    /// λ_k, q′_{k+1} and r_{k+2} from all before.
    void next(int k) {
        Half& rates = rates_[static_cast<std::size_t>(k + 1)];
        products_.multiply(k);
        for (Eigen::Index i = 0; i < links_; ++i)
            pull_.template segment<2>(2 * i) = products_.pull(static_cast<std::size_t>(i));
        accelerate(k);

        const Scalar factor = Scalar((k + 1) * (k + 2)) * Scalar(0.5);
        for (Eigen::Index i = 0; i < links_; ++i) {
            const Scalar along = rods_[2 * i] * relative(rates, 2 * i) + rods_[2 * i + 1] * relative(rates, 2 * i + 1);
            lambda_[i] = -(along + factor * products_.square(static_cast<std::size_t>(i)));
        }
        matrix_.solve(lambda_);
        for (Eigen::Index i = 0; i < links_; ++i) {
            products_.set_pull(k, static_cast<std::size_t>(i), lambda_[i]);
            pull_[2 * i] += rods_[2 * i] * lambda_[i];
            pull_[2 * i + 1] += rods_[2 * i + 1] * lambda_[i];
        }

        accelerate(k);
        rates *= inverse(k + 1);
        if (k + 1 < order_) set_rods(k + 2, rates, inverse(k + 2));
    }

    /// r_k, from coefficient k − 1 of the velocities and 1/k.
    void set_rods(int k, const Half& rates, const Scalar& share) {
        for (Eigen::Index i = 0; i < links_; ++i)
            products_.set_rod(k, static_cast<std::size_t>(i), relative(rates, 2 * i) * share,
                              relative(rates, 2 * i + 1) * share);
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

    Scalar dot(Eigen::Index a, Eigen::Index b) const {
        return rods_[2 * a] * rods_[2 * b] + rods_[2 * a + 1] * rods_[2 * b + 1];
    }
    const Scalar& inverse(int k) const { return inverse_[static_cast<std::size_t>(k - 1)]; }

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
    double reach_ = 0;  // m
    Half rods_;         // r_0
    RodProducts<Scalar, N == Eigen::Dynamic && std::is_same_v<Scalar, double> ? 8 : 1> products_;
    std::vector<Half> rates_;      // q′_k, order by order
    std::vector<Scalar> inverse_;  // 1/k
    Multipliers lambda_;           // λ_k
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

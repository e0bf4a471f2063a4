#pragma once

#include "integrate/lane_series.hpp"
#include "integrate/taylor_series.hpp"
#include "numeric/lanes.hpp"
#include "numeric/subnormals.hpp"
#include "physics/angle_chain.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

namespace doppel {

/// The Taylor series of a chain in angles, from products of series alone: no sine is expanded.
///
/// With the rods r̂_i = l_i (sinθ_i, −cosθ_i) and what lies across them, r_i = r̂_i turned by 90°,
///     r̂_i′ = r_i ω_i .
/// A massless rod pulls along itself only, so the force F_i that it gives to all bobs below it has r_i · F_i = 0, and
///     r̂_i″ = (F_i − F_{i+1}) / m_i − (F_{i−1} − F_i) / m_{i−1}     (r̂_1″ = (F_1 − F_2) / m_1 − g ŷ) .
/// Now with c_k for the coefficient of (t − t_0)^k of each quantity c: r̂″_k = (k + 1) (r_0 ω_{k+1} + R_k), where
///     R_k = Σ_{j=1}^{k+1} r_j ω_{k+1−j} ,    r_0 · F_k = − Σ_{j=1}^k r_j · F_{k−j}
/// are known. Along r̂_0 the equations hold no ω_{k+1}, and give what F_k has there by the matrix of the tensions, the
/// same at every order; across it they give ω_{k+1}. Vectors are kept by their parts across and along the rod at t_0,
/// and r over its length. Four products a link for each pair of orders; the rest is O(N).
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
///         The motion and its matrix: those of AngleChain.
template <class S, int N>
class AngleSeries {
public:
    using Scalar = S;
    using Chain = AngleChain<Scalar, N>;
    using State = typename Chain::State;

    AngleSeries(const Pendulum<Scalar>& p, int order)
        : order_(order),
          chain_(p),
          links_(chain_.w.size()),
          terms_(static_cast<std::size_t>(order + 2), Term(links_)),
          inverse_(static_cast<std::size_t>(order + 2)),
          known_(Half::Zero(links_)),
          along_(known_) {
        for (std::size_t k = 1; k < inverse_.size(); ++k) inverse_[k] = Scalar(1) / Scalar(static_cast<long>(k));
    }

    void expand(const State& y) {
        const NoSubnormals here;
        chain_.update(y);
        term(0).x.setConstant(Scalar(1));
        term(0).rate = y.tail(links_);
        term(1).y = -term(0).rate;
        for (int k = 0; k < order_; ++k) next(k);
        amount_ = greatest(0) + std::sqrt(greatest(1));
    }

    void move(const Scalar& h, State& change) const {
        const NoSubnormals here;
        constexpr Eigen::Index some = 64;  // links at a time: they stay in the cache
        for (Eigen::Index first = 0; first < links_; first += some) {
            const auto size = std::min(some, links_ - first);
            auto angle = change.segment(first, size), rate = change.segment(links_ + first, size);
            angle.setZero();
            rate.setZero();
            for (int k = order_; k > 0; --k) {
                const auto c = term(k).rate.segment(first, size);
                angle = (angle + c * inverse(k + 1)) * h;
                rate = (rate + c) * h;
            }
            angle = (angle + term(0).rate.segment(first, size)) * h;
        }
    }

    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }

    /// Coefficient k of the rate of a link, rad/s^(k+1).
    double rate(int k, int link) const { return plain_value(term(k).rate[link]); }

    double longest_step() const {
        return longest_chain_step(plain_value(chain_.pendulum.reach()), plain_value(chain_.pendulum.gravity));
    }

private:
    using Half = typename Chain::Half;

    /// Coefficients of one order.
    struct Term {
        explicit Term(Eigen::Index links) : x(Half::Zero(links)), y(x), rate(x), across(x), along(x) {}
        Half x, y;           // r over its length, across and along the rods at t_0
        Half rate;           // ω, rad/s
        Half across, along;  // F, N
    };

    /// F_k, ω_{k+1} and r_{k+2} from all before.
    void next(int k) {
        multiply(k);
        const auto &s = chain_.s, &c = chain_.c;
        const Half& across = term(k).across;
        Half& along = term(k).along;
        for (Eigen::Index i = 0; i < links_; ++i) {
            along[i] = Scalar(k + 1) * (chain_.length[i] * along_[i]);
            if (i > 0) along[i] += s[i - 1] * across[i - 1];
            if (i + 1 < links_) along[i] -= s[i] * across[i + 1];
        }
        const Scalar& g = chain_.pendulum.gravity;
        if (k == 0) along[0] -= g * chain_.cos[0];
        chain_.matrix.solve(along);

        for (Eigen::Index i = 0; i < links_; ++i) {
            Scalar sum = across[i] * (i > 0 ? Scalar(chain_.w[i - 1] + chain_.w[i]) : chain_.w[0]);
            if (i > 0) sum += s[i - 1] * along[i - 1] - c[i - 1] * across[i - 1];
            if (i + 1 < links_) sum -= c[i] * across[i + 1] + s[i] * along[i + 1];
            if (k == 0 && i == 0) sum -= g * chain_.sin[0];
            const Scalar turn = sum * (chain_.by_length[i] * inverse(k + 1));
            term(k + 1).rate[i] = turn - known_[i];
            if (k + 1 == order_) continue;
            term(k + 2).x[i] = along_[i] * inverse(k + 2);
            term(k + 2).y[i] = -(turn * inverse(k + 2));
        }
    }

    /// R_k over the length, and F_k across.
    void multiply(int k) {
        Eigen::Index first = 0;
        if constexpr (std::is_same_v<Scalar, double>)  // side by side in registers, each with sums of its own
            for (constexpr int some = 8; first + some <= links_; first += some) multiply<Lanes<some>>(k, first);
        for (; first < links_; ++first) multiply<Scalar>(k, first);
    }
    template <class Pack>
    void multiply(int k, Eigen::Index first) {
        const auto load = [&](const Half& from) -> Pack {
            if constexpr (std::is_same_v<Pack, Scalar>)
                return from[first];
            else
                return Pack::load(from.data() + first);
        };
        const auto store = [&](const Pack& what, Half& to) {
            if constexpr (std::is_same_v<Pack, Scalar>)
                to[first] = what;
            else
                what.store(to.data() + first);
        };
        Pack x(0), y(0), across(0);
        for (int j = 1; j <= k + 1; ++j) {
            const Pack xj = load(term(j).x), yj = load(term(j).y), rate = load(term(k + 1 - j).rate);
            x += xj * rate;
            y += yj * rate;
            if (j > k) break;
            across += xj * load(term(k - j).across) + yj * load(term(k - j).along);
        }
        store(x, known_);
        store(y, along_);
        store(-across, term(k).across);
    }

    /// The greatest |ω_k|.
    double greatest(int k) const {
        double most = 0;
        for (Eigen::Index i = 0; i < links_; ++i) most = greater(most, std::abs(plain_value(term(k).rate[i])));
        return most;
    }

    Term& term(int k) { return terms_[static_cast<std::size_t>(k)]; }
    const Term& term(int k) const { return terms_[static_cast<std::size_t>(k)]; }
    const Scalar& inverse(int k) const { return inverse_[static_cast<std::size_t>(k)]; }

    int order_;
    Chain chain_;
    Eigen::Index links_;
    std::vector<Term> terms_;
    std::vector<Scalar> inverse_;  // 1/k
    Half known_, along_;           // R_k across and along, over the length
    double amount_ = 0;            // of the rates, rad/s
};

/// The chain that a model in angles describes.
template <class Scalar, int N>
const Pendulum<Scalar>& chain_of(const AngleChain<Scalar, N>& model) {
    return model.pendulum;
}
template <class Scalar>
Pendulum<Scalar> chain_of(const DoublePendulum<Scalar>& d) {
    return {{d.m1, d.m2}, {d.l1, d.l2}, {Scalar(0), Scalar(0)}, {Scalar(0), Scalar(0)}, d.g};
}

/// Of two or three links of double: in lanes, but where a mass is much lighter than the next, which costs the mass matrix of
/// the lanes its digits.
template <int N>
class FewLinksSeries {
public:
    using State = doppel::State<double, 2 * N>;

    FewLinksSeries(const Pendulum<double>& p, int order) : lanes_(p, order) {
        constexpr double light = 1.0 / 64;
        for (std::size_t k = 0; k + 1 < N; ++k)
            if (p.mass[k] < light * p.mass[k + 1] && !careful_) careful_.emplace(p, order);
    }

    void expand(const State& y) { careful_ ? careful_->expand(y) : lanes_.expand(y); }
    void move(double h, State& change) const { careful_ ? careful_->move(h, change) : lanes_.move(h, change); }
    double size(int k) const { return careful_ ? careful_->size(k) : lanes_.size(k); }
    double longest_step() const { return lanes_.longest_step(); }
    double rate(int k, int link) const { return careful_ ? careful_->rate(k, link) : lanes_.rate(k, link); }

private:
    LaneSeries<N> lanes_;
    std::optional<AngleSeries<double, N>> careful_;
};

/// The series of a model in angles.
template <class Model, int N>
struct ChainSeries {
    using Scalar = typename Model::Scalar;
    static constexpr auto series = [] {
        if constexpr (std::is_same_v<Scalar, double> && (N == 2 || N == 3))
            return std::type_identity<FewLinksSeries<N>>();
        else
            return std::type_identity<AngleSeries<Scalar, N>>();
    }();
    using Series = typename decltype(series)::type;
    struct type : Series {
        type(const Model& model, int order) : Series(chain_of(model), order) {}
    };
};
template <class Scalar, int N>
struct SeriesOf<AngleChain<Scalar, N>> : ChainSeries<AngleChain<Scalar, N>, N> {};
template <class Scalar>
struct SeriesOf<DoublePendulum<Scalar>> : ChainSeries<DoublePendulum<Scalar>, 2> {};

}  // namespace doppel

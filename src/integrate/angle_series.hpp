#pragma once

#include "integrate/series.hpp"
#include "numeric/subnormals.hpp"
#include "physics/angle_chain.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace doppel {

/// The Taylor series of a chain in angles, from products of series alone, without series of sines.
///
/// With the rods r̂_i = l_i (sinθ_i, −cosθ_i) and the perpendicular vectors r_i, which are r̂_i rotated by 90°,
///     r̂_i′ = r_i ω_i .
/// A massless rod only transmits force along itself. So the force F_i of rod i on all bobs below satisfies r_i · F_i =
/// 0, and
///     r̂_i″ = (F_i − F_{i+1}) / m_i − (F_{i−1} − F_i) / m_{i−1}     (r̂_1″ = (F_1 − F_2) / m_1 − g ŷ) .
/// With c_k the coefficient of (t − t_0)^k of each quantity c: r̂″_k = (k + 1) (r_0 ω_{k+1} + R_k), where
///     R_k = Σ_{j=1}^{k+1} r_j ω_{k+1−j} ,    r_0 · F_k = − Σ_{j=1}^k r_j · F_{k−j}
/// are known. The components along r̂_0 do not contain ω_{k+1}; they give the component of F_k along r̂_0 by the matrix
/// of the tensions, the same at every order. The components across it give ω_{k+1}. Vectors are stored by their
/// components across and along the rod at t_0; r is divided by its length. Each link takes four products for each pair
/// of orders; the rest is O(N).
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
///         The equations of motion and the matrix are those of AngleChain.
template <class S>
class AngleSeries final : public Series<S> {
public:
    using Scalar = S;
    using Chain = AngleChain<Scalar, Eigen::Dynamic>;
    using State = typename Chain::State;

    AngleSeries(const Pendulum<Scalar>& p, int order)
        : Series<Scalar>(longest_chain_step(static_cast<double>(p.reach()), static_cast<double>(p.gravity))),
          order_(order),
          chain_(p),
          links_(chain_.w.size()),
          terms_(static_cast<std::size_t>(order + 2), Term(links_)),
          inverse_(static_cast<std::size_t>(order + 2)),
          known_(Half::Zero(links_)),
          along_(known_) {
        for (std::size_t k = 1; k < inverse_.size(); ++k) inverse_[k] = Scalar(1) / Scalar(static_cast<long>(k));
    }

    void expand(const State& y) override {
        const NoSubnormals here;
        chain_.update(y);
        term(0).x.setConstant(Scalar(1));
        term(0).rate = y.tail(links_);
        term(1).y = -term(0).rate;
        for (int k = 0; k < order_; ++k) next(k);
        this->take_scale();
    }

    void move(const Scalar& h, State& change) override {
        const NoSubnormals here;
        constexpr Eigen::Index some = 64;  // links at a time, which fit in the cache
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

    double rate(int k, Eigen::Index link) const override { return static_cast<double>(term(k).rate[link]); }

private:
    using Half = typename Chain::Half;

    /// The coefficients of one order.
    struct Term {
        explicit Term(Eigen::Index links) : x(Half::Zero(links)), y(x), rate(x), across(x), along(x) {}
        Half x, y;           // r divided by its length, across and along the rods at t_0
        Half rate;           // ω, rad/s
        Half across, along;  // F, N
    };

    /// Computes F_k, ω_{k+1} and r_{k+2} from all earlier coefficients.
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

    /// Computes R_k divided by the length, and F_k across.
    void multiply(int k) {
        Eigen::Index first = 0;
        if constexpr (std::is_same_v<Scalar, double>)  // links side by side in registers, each with sums of its own
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

    Scalar largest(int k) const override {
        using std::abs;
        Scalar maximum(0);
        for (Eigen::Index i = 0; i < links_; ++i) maximum = greater(maximum, Scalar(abs(term(k).rate[i])));
        return maximum;
    }

    Term& term(int k) { return terms_[static_cast<std::size_t>(k)]; }
    const Term& term(int k) const { return terms_[static_cast<std::size_t>(k)]; }
    const Scalar& inverse(int k) const { return inverse_[static_cast<std::size_t>(k)]; }

    int order_;
    Chain chain_;
    Eigen::Index links_;
    std::vector<Term> terms_;
    std::vector<Scalar> inverse_;  // 1/k
    Half known_, along_;           // R_k across and along, divided by the length
};

}  // namespace doppel

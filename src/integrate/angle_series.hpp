#pragma once

#include "integrate/lane_series.hpp"
#include "integrate/taylor_series.hpp"
#include "physics/angle_chain.hpp"

#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

namespace doppel {

/// The Taylor series of a chain in angles, from products of series alone: no sine is expanded.
///
/// With the rods r̂_i = l_i (sinθ_i, −cosθ_i) and what lies across them, r_i = l_i (cosθ_i, sinθ_i),
///     r̂_i′ = r_i ω_i ,    r_i = r̂_i turned by 90° ,    q_i = Σ_{j≤i} r̂_j .
/// A massless rod pulls along itself only, so what it must give to all bobs below it,
///     F_i = Σ_{j≥i} m_j (q_j″ + g ŷ) ,    has    r_i · F_i = 0 .
/// Now with c_k for the coefficient of (t − t_0)^k of each quantity c: r̂″_k = (k + 1) (r_0 ω_{k+1} + R_k), where
///     R_k = Σ_{j=1}^{k+1} r_j ω_{k+1−j}
/// is known, F is linear in r̂″, and so a = (k + 1) ω_{k+1} solves
///     M_0 a = −( r_0 · F_k[R] + Σ_{j=1}^k r_j · F_{k−j} ) ,    M_ij = Σ_{k≥max(i,j)} m_k r_i · r_j ,
/// with the same mass matrix at every order. Four products a link for each pair of orders; the rest is O(N).
/// Source  recurrences of this kind: Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
///         The motion: that of AngleChain.
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
          blocks_((links_ + width - 1) / width),
          terms_(static_cast<std::size_t>(blocks_ * (order + 2))),
          sums_(static_cast<std::size_t>(blocks_)),
          inverse_(static_cast<std::size_t>(order + 2)),
          moment_(Chain::Half::Zero(links_)),
          turn_(moment_),
          bob_x_(moment_),
          bob_y_(moment_) {
        for (std::size_t k = 1; k < inverse_.size(); ++k) inverse_[k] = Scalar(1) / Scalar(static_cast<long>(k));
    }

    void expand(const State& y) {
        chain_.update(y);
        for (Eigen::Index i = 0; i < links_; ++i) {
            const Scalar x = length(i) * chain_.cos[i], up = length(i) * chain_.sin[i], rate = y[links_ + i];
            at(0, i, &Term::x) = x;
            at(0, i, &Term::y) = up;
            at(0, i, &Term::rate) = rate;
            at(1, i, &Term::x) = -(up * rate);
            at(1, i, &Term::y) = x * rate;
        }
        for (int k = 0; k < order_; ++k) next(k);
        amount_ = greatest(0) + std::sqrt(greatest(1));
    }

    void move(const Scalar& h, State& change) const {
        for (Eigen::Index i = 0; i < links_; ++i) {
            Scalar angle(0), rate(0);
            for (int k = order_; k > 0; --k) {
                const Scalar& c = at(k, i, &Term::rate);
                angle = (angle + c * inverse(k + 1)) * h;
                rate = (rate + c) * h;
            }
            change[i] = (angle + at(0, i, &Term::rate)) * h;
            change[links_ + i] = rate;
        }
    }

    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }

    double longest_step() const {
        return longest_chain_step(plain_value(chain_.pendulum.reach()), plain_value(chain_.pendulum.gravity));
    }

private:
    /// Numbers of the links whose products are formed side by side; each lane has sums of its own, so the bits are the
    /// same at any width.
    using Pack = std::conditional_t<std::is_same_v<Scalar, double>, Lanes<4>, Scalar>;
    static constexpr Eigen::Index width = is_lanes<Pack> ? 4 : 1;
    using Row = std::array<Scalar, static_cast<std::size_t>(width)>;

    static Pack load(const Row& row) {
        if constexpr (is_lanes<Pack>)
            return Pack::load(row.data());
        else
            return row[0];
    }
    static void store(const Pack& side, Row& row) {
        if constexpr (is_lanes<Pack>)
            side.store(row.data());
        else
            row[0] = side;
    }

    /// Coefficients of one order.
    struct Term {
        Row x{}, y{};    // r, m
        Row rate{};      // ω, rad/s
        Row fx{}, fy{};  // F, N
    };
    struct Sums {
        Row x{}, y{};  // R_k, then R_k + r_0 ω_{k+1}
        Row moment{};  // Σ_{j=1}^k r_j · F_{k−j}
    };

    /// ω_{k+1}, r_{k+2} and F_k from all before.
    void next(int k) {
        for (Eigen::Index b = 0; b < blocks_; ++b)
            multiply(&terms_[index(b, 0)], k, sums_[static_cast<std::size_t>(b)]);
        find_forces(k);
        for (Eigen::Index i = 0; i < links_; ++i)
            moment_[i] = -(sum(i, &Sums::moment) + at(0, i, &Term::x) * at(k, i, &Term::fx) +
                           at(0, i, &Term::y) * at(k, i, &Term::fy));
        chain_.solve_mass(moment_, turn_);
        for (Eigen::Index i = 0; i < links_; ++i) {
            const Scalar rate = turn_[i] * inverse(k + 1);
            Scalar &x = sum(i, &Sums::x), &y = sum(i, &Sums::y);
            x += at(0, i, &Term::x) * rate;
            y += at(0, i, &Term::y) * rate;
            at(k + 1, i, &Term::rate) = rate;
            if (k + 1 == order_) continue;
            at(k + 2, i, &Term::x) = -(y * inverse(k + 2));
            at(k + 2, i, &Term::y) = x * inverse(k + 2);
        }
        if (k + 1 < order_) find_forces(k);
    }

    /// The sums of products for one block of links.
    static void multiply(const Term* term, int k, Sums& sums) {
        Pack x = load(term[k + 1].x) * load(term[0].rate), y = load(term[k + 1].y) * load(term[0].rate);
        Pack moment_x(0), moment_y(0);
        for (int j = 1; j <= k; ++j) {
            const Term &one = term[j], &other = term[k - j], &after = term[k + 1 - j];
            x += load(one.x) * load(after.rate);
            y += load(one.y) * load(after.rate);
            moment_x += load(one.x) * load(other.fx);
            moment_y += load(one.y) * load(other.fy);
        }
        store(x, sums.x);
        store(y, sums.y);
        store(moment_x + moment_y, sums.moment);
    }

    /// F_k, of r̂″_k = (k + 1) × what the sums hold.
    void find_forces(int k) {
        Scalar x(0), y(0);
        for (Eigen::Index i = 0; i < links_; ++i) {
            x += sum(i, &Sums::x);
            y += sum(i, &Sums::y);
            bob_x_[i] = x;
            bob_y_[i] = y;
        }
        const Scalar factor(k + 1);
        x = y = Scalar(0);
        for (Eigen::Index i = links_ - 1; i >= 0; --i) {
            const auto& m = chain_.pendulum.mass[static_cast<std::size_t>(i)];
            x += m * bob_x_[i];
            y += m * bob_y_[i];
            if (k == 0) y += m * chain_.pendulum.gravity;
            at(k, i, &Term::fx) = x * factor;
            at(k, i, &Term::fy) = y * factor;
        }
    }

    /// The greatest |ω_k|.
    double greatest(int k) const {
        double most = 0;
        for (Eigen::Index i = 0; i < links_; ++i) most = greater(most, std::abs(plain_value(at(k, i, &Term::rate))));
        return most;
    }

    std::size_t index(Eigen::Index block, int k) const { return static_cast<std::size_t>(block * (order_ + 2) + k); }
    static std::size_t lane(Eigen::Index i) { return static_cast<std::size_t>(i % width); }
    Scalar& at(int k, Eigen::Index i, Row Term::*row) { return (terms_[index(i / width, k)].*row)[lane(i)]; }
    const Scalar& at(int k, Eigen::Index i, Row Term::*row) const {
        return (terms_[index(i / width, k)].*row)[lane(i)];
    }
    Scalar& sum(Eigen::Index i, Row Sums::*row) { return (sums_[static_cast<std::size_t>(i / width)].*row)[lane(i)]; }
    const Scalar& length(Eigen::Index i) const { return chain_.pendulum.length[static_cast<std::size_t>(i)]; }
    const Scalar& inverse(int k) const { return inverse_[static_cast<std::size_t>(k)]; }

    int order_;
    Chain chain_;
    Eigen::Index links_, blocks_;
    std::vector<Term> terms_;      // block by block, in each order by order
    std::vector<Sums> sums_;       // of each block
    std::vector<Scalar> inverse_;  // 1/k
    typename Chain::Half moment_, turn_, bob_x_, bob_y_;
    double amount_ = 0;  // of the rates, rad/s
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

/// The series of a model in angles: for two and three links of double in lanes.
template <class Model, int N>
struct ChainSeries {
    using Scalar = typename Model::Scalar;
    static constexpr bool in_lanes = std::is_same_v<Scalar, double> && (N == 2 || N == 3);
    using Series = std::conditional_t<in_lanes, LaneSeries<N>, AngleSeries<Scalar, N>>;
    struct type : Series {
        type(const Model& model, int order) : Series(chain_of(model), order) {}
    };
};
template <class Scalar, int N>
struct SeriesOf<AngleChain<Scalar, N>> : ChainSeries<AngleChain<Scalar, N>, N> {};
template <class Scalar>
struct SeriesOf<DoublePendulum<Scalar>> : ChainSeries<DoublePendulum<Scalar>, 2> {};

}  // namespace doppel

#pragma once

#include "numeric/ball.hpp"
#include "numeric/dual.hpp"
#include "numeric/tape.hpp"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace doppel {

using DoubleBall = Ball<double>;
using TangentBall = Dual<DoubleBall, 4>;

/// Σ a b, with the roundings counted together.
template <class Scalar>
class SumOfProducts<Ball<Scalar>> {
public:
    void add(const Ball<Scalar>& a, const Ball<Scalar>& b) {
        sum_ += a.center * b.center;
        spread_ += a.center_size() * b.radius + b.center_size() * a.radius + a.radius * b.radius;
        sizes_ += a.center_size() * b.center_size();
        ++count_;
    }
    Ball<Scalar> value() const {
        // each of the products and of the partial sums is rounded once; so are those of the sizes
        const double rounding = (count_ + 1) * 2 * Ball<Scalar>::roundoff * sizes_;
        return {sum_, widened(widened(spread_ + rounding) * (1 + count_ * 0x1p-50))};
    }

private:
    Scalar sum_ = Scalar(0);
    double spread_ = 0, sizes_ = 0, count_ = 0;
};
template <>
class SumOfProducts<TangentBall> {
public:
    void add(const TangentBall& a, const TangentBall& b) {
        value_.add(a.value, b.value);
        for (Eigen::Index i = 0; i < 4; ++i) {
            tangent_[i].add(a.value, b.tangent[i]);
            tangent_[i].add(b.value, a.tangent[i]);
        }
    }
    TangentBall value() const {
        TangentBall sum(value_.value());
        for (Eigen::Index i = 0; i < 4; ++i) sum.tangent[i] = tangent_[i].value();
        return sum;
    }

private:
    SumOfProducts<DoubleBall> value_, tangent_[4];
};

/// The ball around 0 with all sizes of x, and of its derivatives.
template <class Scalar>
DoubleBall bound_of(const Ball<Scalar>& x) {
    return {0, x.size()};
}
inline TangentBall bound_of(const TangentBall& x) {
    return {bound_of(x.value), x.tangent.unaryExpr([](const DoubleBall& entry) { return bound_of(entry); })};
}
/// Whether a bound is finite and contains another.
inline bool contains(const DoubleBall& bound, const DoubleBall& other) {
    return other.radius <= bound.radius && std::isfinite(bound.radius);
}
inline bool contains(const TangentBall& bound, const TangentBall& other) {
    const auto each = [](const DoubleBall& one, const DoubleBall& two) { return contains(one, two); };
    return each(bound.value, other.value) && bound.tangent.binaryExpr(other.tangent, each).all();
}

/// A differential equation of sums and products, and the Taylor series of its solution in τ = t/h with a remainder,
///     y(τ) = Σ_{k ≤ n} c_k τ^k + τ^(n+1) r(τ) ,   0 ≤ τ ≤ 1 ,
/// where r(τ) is in a bound. Number is a ball, or one with derivatives by the start.
template <class Number>
class BallSeries {
public:
    using Quantity = Taped<Number>;

    /// `order` = n
    explicit BallSeries(int order) : order_(order), tape_(order + 1) {}

    /// Begins another equation.
    void clear() {
        tape_.clear();
        states_.clear();
    }
    /// Each state needs a rate.
    Quantity state(const Number& start) { return Quantity::argument(start, tape_); }
    void set_rate(const Quantity& state, const Quantity& rate) { states_.push_back({state, rate}); }

    /// Computes the series for a step h, s.
    void expand(const Number& h) {
        tape_.finish();
        for (const auto& [state, rate, image] : states_) tape_.term(state.node(), 0) = state.value;
        for (int k = 0; k <= order_; ++k) {
            tape_.compute(k);
            const Number step = h / Number(k + 1);
            for (const auto& [state, rate, image] : states_)
                tape_.term(state.node(), k + 1) = step * tape_.term(rate.node(), k);
        }
        last_step_ = bound_of(h) / Bound(order_ + 2);
        bounds_.assign(tape_.nodes().size(), {});
        for (std::size_t i = 0; i < bounds_.size(); ++i)
            for (int k = 0; k <= order_; ++k) bounds_[i].size += bound_of(tape_.series(static_cast<int>(i))[k]);
        for (std::size_t i = 0; i < bounds_.size(); ++i) bounds_[i].tail = tail(tape_.nodes()[i]);
    }
    /// Finds remainders of the states. Picard's operator maps all functions with these remainders to such functions, so
    /// that a solution exists (Schauder) and is one of them. False if none are found.
    bool find_remainders() {
        constexpr int attempts = 12;
        for (int attempt = 0; attempt < attempts; ++attempt) {
            for (std::size_t i = 0; i < bounds_.size(); ++i)
                if (const auto& node = tape_.nodes()[i]; node.operation != Operation::argument)
                    bounds_[i].rest = remainder(node, bounds_[i].tail);
            bool is_proved = true;
            for (auto& [state, rate, image] : states_) {
                image = bound_of(tape_.term(state.node(), order_ + 1)) + last_step_ * bounds(rate.node()).rest;
                is_proved = is_proved && contains(bounds(state.node()).rest, image);
            }
            for (const auto& [state, rate, image] : states_)
                bounds(state.node()).rest = is_proved ? image : Bound(2) * image;
            if (is_proved) return true;
        }
        return false;
    }

    /// A state at τ.
    Number value(int node, const Number& tau, bool has_remainder = true) const {
        const auto* c = tape_.series(node);
        Number sum = has_remainder ? Number(bounds(node).rest) : Number(0);
        for (int k = order_; k >= 0; --k) sum = sum * tau + c[k];
        return sum;
    }
    const Number& coefficient(int node, int k) const { return tape_.series(node)[k]; }

private:
    using Bound = decltype(bound_of(Number()));
    using Operation = typename Tape<Number>::Operation;
    using Node = typename Tape<Number>::Node;
    struct State {
        Quantity state, rate;
        Bound image{};  // of the remainder by Picard's operator
    };
    struct Bounds {
        // Σ |c_k|; for a product, Σ |a_i b_j| over i + j > n; the remainder
        Bound size{}, tail{}, rest{};
    };

    Bounds& bounds(int node) { return bounds_[static_cast<std::size_t>(node)]; }
    const Bounds& bounds(int node) const { return bounds_[static_cast<std::size_t>(node)]; }

    Bound tail(const Node& node) const {
        if (node.operation != Operation::product || node.a < 0 || node.b < 0) return Bound(0);
        const Number *a = tape_.series(node.a), *b = tape_.series(node.b);
        SumOfProducts<Bound> sum;
        Bound of_b(0);
        for (int i = 1; i <= order_; ++i) {
            of_b += bound_of(b[order_ + 1 - i]);
            sum.add(bound_of(a[i]), of_b);
        }
        return sum.value();
    }
    Bound remainder(const Node& node, const Bound& tail) const {
        const Bounds constant{.size = bound_of(node.constant)};
        const auto &a = node.a < 0 ? constant : bounds(node.a), &b = node.b < 0 ? constant : bounds(node.b);
        if (node.operation == Operation::sum || node.operation == Operation::difference) return a.rest + b.rest;
        if (node.operation != Operation::product) throw std::logic_error("no remainder of this operation is known");
        return a.size * b.rest + a.rest * (b.size + b.rest) + tail;
    }

    int order_;
    Tape<Number> tape_;
    std::vector<State> states_;
    std::vector<Bounds> bounds_;  // of all nodes
    Bound last_step_{};           // h/(n + 2)
};

}  // namespace doppel

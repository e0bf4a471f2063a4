#pragma once

#include "numeric/ball.hpp"
#include "numeric/dual.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace doppel {

using DoubleBall = Ball<double>;
using TangentBall = Dual<DoubleBall, 4>;

/// Σ a b, with the roundings counted together.
template <class Number>
class SumOfProducts;
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
        const double rounding = (count_ + 1) * 2 * unit_roundoff<Scalar> * sizes_;
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
    bool all = contains(bound.value, other.value);
    for (Eigen::Index i = 0; i < 4; ++i) all = all && contains(bound.tangent[i], other.tangent[i]);
    return all;
}

/// A differential equation of sums and products, and the Taylor series of its solution in τ = t/h with a remainder,
///     y(τ) = Σ_{k ≤ n} c_k τ^k + τ^(n+1) r(τ) ,   0 ≤ τ ≤ 1 ,
/// where r(τ) is in a bound. Number is a ball, or one with derivatives by the start.
template <class Number>
class BallSeries {
    using Bound = decltype(bound_of(Number()));
    enum class Operation : unsigned char { constant, state, sum, difference, product };

public:
    /// A quantity of the equation.
    class Term {
    public:
        Term operator+(const Term& b) const { return series_->add(Operation::sum, node_, b.node_); }
        Term operator-(const Term& b) const { return series_->add(Operation::difference, node_, b.node_); }
        Term operator*(const Term& b) const { return series_->add(Operation::product, node_, b.node_); }
        friend Term operator+(const Number& a, const Term& b) { return b.constant(a) + b; }
        friend Term operator*(const Number& a, const Term& b) { return b.constant(a) * b; }

        const Number& start() const { return series_->nodes_[node_].c.front(); }
        void set_rate(const Term& rate) const { series_->nodes_[node_].a = rate.node_; }

    private:
        friend BallSeries;
        Term(BallSeries& series, std::size_t node) : series_(&series), node_(node) {}
        Term constant(const Number& value) const {
            const Term made = series_->add(Operation::constant);
            series_->nodes_.back().c.front() = value;
            return made;
        }

        BallSeries* series_;
        std::size_t node_;
    };

    explicit BallSeries(int order) : order_(static_cast<std::size_t>(order)), step_(order_ + 3) {}
    BallSeries(const BallSeries&) = delete;
    BallSeries& operator=(const BallSeries&) = delete;

    /// A quantity with a rate. `start` follows from the starts of earlier terms; without it, set_start() is used.
    Term state(std::function<Number()> start = {}) {
        const Term made = add(Operation::state);
        nodes_.back().start = std::move(start);
        return made;
    }
    void set_start(std::size_t node, const Number& start) { nodes_[node].c.front() = start; }

    /// Computes the coefficients up to order n for a step h, s.
    void expand(const Number& h) {
        for (std::size_t k = 1; k < step_.size(); ++k) step_[k] = h / Number(static_cast<int>(k));
        for (std::size_t k = 0; k <= order_; ++k)
            for (auto& node : nodes_) node.c[k] = coefficient(node, k);
        for (auto& node : nodes_) {
            node.size = Bound(0);
            for (const auto& c : node.c) node.size += bound_of(c);
        }
        for (auto& node : nodes_)
            if (node.operation == Operation::product) node.tail = tail(nodes_[node.a], nodes_[node.b]);
    }
    /// Finds remainders of the states. Picard's operator maps all functions with these remainders to such functions, so
    /// that a solution exists (Schauder) and is one of them. False if none are found.
    bool find_remainders() {
        for (auto& node : nodes_) node.rest = Bound(0);
        constexpr int attempts = 12;
        for (int attempt = 0; attempt < attempts; ++attempt) {
            for (auto& node : nodes_)
                if (node.operation != Operation::state) node.rest = remainder(node);
            bool is_proved = true;
            for (auto& node : nodes_)
                if (node.operation == Operation::state) {
                    node.image = remainder(node);
                    is_proved = is_proved && contains(node.rest, node.image);
                }
            for (auto& node : nodes_)
                if (node.operation == Operation::state) node.rest = is_proved ? node.image : Bound(2) * node.image;
            if (is_proved) return true;
        }
        return false;
    }

    /// At τ.
    Number value(std::size_t node, const Number& tau, bool has_remainder = true) const {
        const auto& c = nodes_[node].c;
        Number sum = has_remainder ? Number(nodes_[node].rest) : Number(0);
        for (std::size_t k = c.size(); k-- > 0;) sum = sum * tau + c[k];
        return sum;
    }
    const Number& coefficient(std::size_t node, int k) const { return nodes_[node].c[static_cast<std::size_t>(k)]; }

private:
    struct Node {
        Operation operation;
        std::size_t a, b;  // operands; a = rate of a state
        std::vector<Number> c;
        std::function<Number()> start{};
        // Σ |c_k|; of products, Σ |a_i b_j| over i + j > n; the remainder; its image by Picard's operator
        Bound size{}, tail{}, rest{}, image{};
    };

    Term add(Operation operation, std::size_t a = 0, std::size_t b = 0) {
        nodes_.push_back({operation, a, b, std::vector<Number>(order_ + 1)});
        return {*this, nodes_.size() - 1};
    }

    Number coefficient(const Node& node, std::size_t k) const {
        const auto &a = nodes_[node.a], &b = nodes_[node.b];
        switch (node.operation) {
            case Operation::constant:
                break;
            case Operation::state:
                if (k > 0) return step_[k] * a.c[k - 1];
                return node.start ? node.start() : node.c[0];
            case Operation::sum:
                return a.c[k] + b.c[k];
            case Operation::difference:
                return a.c[k] - b.c[k];
            case Operation::product:
                return &a == &b ? square(a, k) : convolution(a, b, k, a.operation == Operation::constant ? 0 : k);
        }
        return node.c[k];
    }
    /// Σ a_j b_{k−j} over 0 ≤ j ≤ last
    static Number convolution(const Node& a, const Node& b, std::size_t k, std::size_t last) {
        SumOfProducts<Number> sum;
        for (std::size_t j = 0; j <= last; ++j) sum.add(a.c[j], b.c[k - j]);
        return sum.value();
    }
    static Number square(const Node& a, std::size_t k) {
        if (k == 0) return a.c[0] * a.c[0];
        const Number half = convolution(a, a, k, (k - 1) / 2), sum = half + half;
        return k % 2 == 0 ? sum + a.c[k / 2] * a.c[k / 2] : sum;
    }
    Bound tail(const Node& a, const Node& b) const {
        if (a.operation == Operation::constant) return Bound(0);
        SumOfProducts<Bound> sum;
        Bound of_b(0);
        for (std::size_t i = 1; i <= order_; ++i) {
            of_b += bound_of(b.c[order_ + 1 - i]);
            sum.add(bound_of(a.c[i]), of_b);
        }
        return sum.value();
    }
    Bound remainder(const Node& node) const {
        const auto &a = nodes_[node.a], &b = nodes_[node.b];
        switch (node.operation) {
            case Operation::constant:
                break;
            case Operation::state:
                return bound_of(coefficient(node, order_ + 1)) + bound_of(step_[order_ + 2]) * a.rest;
            case Operation::sum:
            case Operation::difference:
                return a.rest + b.rest;
            case Operation::product: {
                SumOfProducts<Bound> sum;
                sum.add(a.size, b.rest);
                sum.add(a.rest, b.size + b.rest);
                return sum.value() + node.tail;
            }
        }
        return Bound(0);
    }

    std::size_t order_;         // n
    std::vector<Number> step_;  // h/k
    std::vector<Node> nodes_;
};

}  // namespace doppel

#pragma once

#include "numeric/ball.hpp"
#include "numeric/dual.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

template <>
struct Eigen::NumTraits<doppel::UpperBound> : Eigen::GenericNumTraits<doppel::UpperBound> {
    enum {
        IsComplex = 0,
        IsInteger = 0,
        IsSigned = 0,
        RequireInitialization = 1,
        ReadCost = 1,
        AddCost = 3,
        MulCost = 3
    };
};

namespace doppel {

using DoubleBall = Ball<double>;
using TangentBall = Dual<DoubleBall, 4>;
using TangentBound = Dual<UpperBound, 4>;

template <class Scalar>
UpperBound size_of(const Ball<Scalar>& x) {
    return x.size();
}
inline TangentBound size_of(const TangentBall& x) {
    TangentBound size(x.value.size());
    for (Eigen::Index i = 0; i < 4; ++i) size.tangent[i] = x.tangent[i].size();
    return size;
}
template <class Scalar>
double center_size(const Ball<Scalar>& x) {
    return x.center_size();
}
inline double center_size(const TangentBall&) {
    return 0;  // not used
}

/// Σ a b. Of balls, the roundings are counted together.
template <class Number>
class SumOfProducts {
public:
    void add(const Number& a, const Number& b, double, double) { sum_ += a * b; }
    const Number& value() const { return sum_; }

private:
    Number sum_ = Number(0);
};
template <class Scalar>
class SumOfProducts<Ball<Scalar>> {
public:
    void add(const Ball<Scalar>& a, const Ball<Scalar>& b, double size_a, double size_b) {
        sum_ += a.center * b.center;
        spread_ += size_a * b.radius + size_b * a.radius + a.radius * b.radius;
        sizes_ += size_a * size_b;
        ++count_;
    }
    Ball<Scalar> value() const {
        // each of the products and of the partial sums is rounded once; so are those of the sizes
        const double rounding = (count_ + 1) * 2 * unit_roundoff<Scalar> * sizes_;
        return Ball<Scalar>(sum_).widened_by(widened(spread_ + rounding) * (1 + count_ * 0x1p-50));
    }

private:
    Scalar sum_ = Scalar(0);
    double spread_ = 0, sizes_ = 0, count_ = 0;
};

/// 1/x and its derivatives, for |x| ≥ least and the sizes x of its derivatives; infinite unless least > 0.
inline UpperBound inverse_bound(const UpperBound&, double least) {
    return least > 0 ? widened(1 / least) : std::numeric_limits<double>::infinity();
}
inline TangentBound inverse_bound(const TangentBound& x, double least) {
    const auto inverse = inverse_bound(x.value, least);
    return {inverse, inverse * inverse * x.tangent};
}
inline bool is_within(const UpperBound& a, const UpperBound& b) {
    return a.value <= b.value && std::isfinite(b.value);
}
inline bool is_within(const TangentBound& a, const TangentBound& b) {
    for (Eigen::Index i = 0; i < 4; ++i)
        if (!is_within(a.tangent[i], b.tangent[i])) return false;
    return is_within(a.value, b.value);
}
inline const DoubleBall& value_of(const TangentBall& x) {
    return x.value;
}
inline double value_of(const TangentBound& x) {
    return x.value.value;
}
inline double value_of(const UpperBound& x) {
    return x.value;
}
template <class Scalar>
const Ball<Scalar>& value_of(const Ball<Scalar>& x) {
    return x;
}

/// The operations of a right-hand side, and the Taylor series of all their results in τ = t/h, with remainders
/// τ^(order + 1) r, 0 ≤ τ ≤ 1. Number is a ball, or one with derivatives by the start.
template <class Number>
class BallSeries {
public:
    using Bound = decltype(size_of(Number(0)));

    explicit BallSeries(int order) : order_(order), terms_(static_cast<std::size_t>(order) + 1) {}

    int state(const Number& start) { return add(Operation::integral, -1, -1, start); }
    void set_rate(int state, int rate) { nodes_[static_cast<std::size_t>(state)].a = rate; }
    void set_start(int state, const Number& start) { nodes_[static_cast<std::size_t>(state)].constant = start; }
    int sum(int a, int b) { return add(Operation::sum, a, b); }
    int difference(int a, int b) { return add(Operation::difference, a, b); }
    int product(int a, int b) { return add(Operation::product, a, b); }
    int scaled(const Number& factor, int a) { return add(Operation::scaled, a, -1, factor); }
    int shifted(const Number& constant, int a) { return add(Operation::shifted, a, -1, constant); }
    /// 1/a, where a ≥ least > 0 is known for all arguments; otherwise least = 0.
    int inverse(int a, double least) { return add(Operation::inverse, a, -1, Number(0), least); }

    /// Computes all coefficients for a step h, s.
    void expand(const Number& h) {
        h_ = h;
        for (std::size_t k = 0; k < terms_; ++k)
            for (auto& node : nodes_) {
                node.c[k] = coefficient(node, k);
                node.sizes[k] = center_size(node.c[k]);
            }
        for (auto& node : nodes_) {
            node.sum = Bound(0);
            for (const auto& c : node.c) node.sum += size_of(c);
        }
        for (auto& node : nodes_)
            node.tail = node.operation == Operation::product   ? tail(at(node.a), at(node.b))
                        : node.operation == Operation::inverse ? tail(at(node.a), node)
                                                               : Bound(0);
    }
    /// Finds remainders of the states. Picard's operator maps all functions with these remainders to such functions, so
    /// that a solution exists (Schauder) and is one of them. False if none are found.
    bool find_remainders() {
        for (auto& node : nodes_) node.rest = Bound(0);
        bool is_proved = false;
        constexpr int attempts = 12;
        for (int attempt = 0; attempt < attempts; ++attempt) {
            evaluate_remainders();
            const bool was_proved = is_proved;
            is_proved = true;
            for (auto& node : nodes_)
                if (node.operation == Operation::integral) {
                    node.image = integral_remainder(node);
                    is_proved &= is_within(node.image, node.rest);
                }
            is_proved |= was_proved;  // then this is a refinement
            for (auto& node : nodes_)
                if (node.operation == Operation::integral)
                    node.rest = is_proved ? node.image : Bound(UpperBound(2)) * node.image + tiny();
            if (was_proved) break;
        }
        return is_proved;
    }

    /// At τ, without the remainder.
    Number value(int node, const Number& tau) const {
        const auto& c = at(node).c;
        Number sum = c.back();
        for (std::size_t k = terms_ - 1; k-- > 0;) sum = sum * tau + c[k];
        return sum;
    }
    const Bound& remainder(int node) const { return at(node).rest; }
    /// The size of the coefficient k of a state.
    double size(int node, int k) const { return value_of(at(node).c[static_cast<std::size_t>(k)]).size(); }
    int order() const { return order_; }

private:
    enum class Operation : unsigned char { integral, sum, difference, product, scaled, shifted, inverse };
    struct Node {
        Operation operation;
        int a, b;
        Number constant;
        double least;
        std::vector<Number> c;
        std::vector<double> sizes;  // of centres
        // sum of the sizes of coefficients; of products beyond the order; the remainder; its image by Picard's operator
        Bound sum{}, tail{}, rest{}, image{};
    };

    int add(Operation operation, int a, int b, const Number& constant = Number(0), double least = 0) {
        nodes_.push_back(
            {operation, a, b, constant, least, std::vector<Number>(terms_, Number(0)), std::vector<double>(terms_)});
        return static_cast<int>(nodes_.size()) - 1;
    }
    const Node& at(int node) const { return nodes_[static_cast<std::size_t>(node)]; }

    static Bound tiny() {
        Bound all(UpperBound(0x1p-900));
        if constexpr (requires { all.tangent; }) all.tangent.setConstant(UpperBound(0x1p-900));
        return all;
    }
    static Number convolution(const Node& a, const Node& b, std::size_t first, std::size_t k) {
        SumOfProducts<Number> sum;
        for (std::size_t j = first; j <= k; ++j) sum.add(a.c[j], b.c[k - j], a.sizes[j], b.sizes[k - j]);
        return sum.value();
    }
    static Number square(const Node& a, std::size_t k) {
        SumOfProducts<Number> half;
        for (std::size_t j = 0; 2 * j < k; ++j) half.add(a.c[j], a.c[k - j], a.sizes[j], a.sizes[k - j]);
        const Number sum = half.value() + half.value();
        return k % 2 == 0 ? sum + a.c[k / 2] * a.c[k / 2] : sum;
    }
    Number coefficient(const Node& node, std::size_t k) const {
        switch (node.operation) {
            case Operation::integral:
                return k == 0 ? node.constant : h_ * at(node.a).c[k - 1] / Number(static_cast<int>(k));
            case Operation::sum:
                return at(node.a).c[k] + at(node.b).c[k];
            case Operation::difference:
                return at(node.a).c[k] - at(node.b).c[k];
            case Operation::product:
                return node.a == node.b ? square(at(node.a), k) : convolution(at(node.a), at(node.b), 0, k);
            case Operation::scaled:
                return node.constant * at(node.a).c[k];
            case Operation::shifted:
                return k == 0 ? node.constant + at(node.a).c[0] : at(node.a).c[k];
            case Operation::inverse:
                return k == 0 ? Number(1) / at(node.a).c[0] : -(convolution(at(node.a), node, 1, k) * node.c[0]);
        }
        return Number(0);
    }
    /// Σ |a_i| |b_j| over i + j > order
    Bound tail(const Node& a, const Node& b) const {
        Bound sum(0), of_b(0);
        for (std::size_t i = 1; i < terms_; ++i) {
            of_b += size_of(b.c[terms_ - i]);
            sum += size_of(a.c[i]) * of_b;
        }
        return sum;
    }
    /// At most |x| in the step; ≤ 0 if it may vanish.
    static double least(const Node& node) {
        UpperBound others(value_of(node.rest));
        for (auto c = node.c.begin() + 1; c != node.c.end(); ++c) others += value_of(*c).size();
        const double least = value_of(node.c.front()).least() - others.value;
        return least > 0 ? least * (1 - 0x1p-50) : least;
    }

    /// Of all nodes, from those of the states.
    void evaluate_remainders() {
        for (auto& node : nodes_) {
            const auto &a = at(std::max(node.a, 0)), &b = at(std::max(node.b, 0));
            switch (node.operation) {
                case Operation::integral:
                    break;
                case Operation::sum:
                case Operation::difference:
                    node.rest = a.rest + b.rest;
                    break;
                case Operation::product:
                    node.rest = node.tail + a.sum * b.rest + b.sum * a.rest + a.rest * b.rest;
                    break;
                case Operation::scaled:
                    node.rest = size_of(node.constant) * a.rest;
                    break;
                case Operation::shifted:
                    node.rest = a.rest;
                    break;
                case Operation::inverse:  // u − û = (1 − û a)/a
                    node.rest =
                        (node.tail + node.sum * a.rest) * inverse_bound(a.sum + a.rest, std::max(node.least, least(a)));
                    break;
            }
        }
    }
    Bound integral_remainder(const Node& node) const {
        const Bound h = size_of(h_);
        return h * (size_of(at(node.a).c.back()) * Bound(UpperBound(widened(1.0 / (order_ + 1)))) +
                    at(node.a).rest * Bound(UpperBound(widened(1.0 / (order_ + 2)))));
    }

    int order_;
    std::size_t terms_;
    Number h_ = Number(0);
    std::vector<Node> nodes_;
};

}  // namespace doppel

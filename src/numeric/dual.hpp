#pragma once

#include "numeric/sin_cos.hpp"

#include <Eigen/Core>

#include <cmath>
#include <limits>
#include <type_traits>

namespace doppel {

/// A number and its derivatives along N directions: f(x + Σ ε_i e_i) = f(x) + Σ ε_i ∂f·e_i with ε_i ε_j = 0. Computing
/// with dual numbers gives exact derivatives (forward-mode automatic differentiation). If the i-th entry of a state
/// starts with the tangent e_i, its end contains the Jacobian of the flow.
/// Comparisons compare the values. A plain number is a constant, with tangents 0.
/// Source  Griewank & Walther, Evaluating Derivatives, §3.1.
template <class Scalar, int N>
struct Dual {
    using Tangent = Eigen::Matrix<Scalar, N, 1>;

    Scalar value;
    Tangent tangent;

    Dual() : Dual(Scalar(0)) {}
    Dual(const Scalar& constant) : value(constant), tangent(Tangent::Zero()) {}
    template <class Number>
    requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, Scalar>) Dual(Number constant)
        : Dual(Scalar(constant)) {}
    template <class Vector>
    Dual(const Scalar& x, const Eigen::MatrixBase<Vector>& dx) : value(x), tangent(dx) {}

    /// Variable number `direction` with the value x.
    static Dual variable(const Scalar& x, Eigen::Index direction) { return {x, Tangent::Unit(direction)}; }

    Dual& operator+=(const Dual& b) {
        value += b.value;
        tangent += b.tangent;
        return *this;
    }
    Dual& operator-=(const Dual& b) {
        value -= b.value;
        tangent -= b.tangent;
        return *this;
    }
    Dual& operator*=(const Dual& b) { return *this = *this * b; }
    Dual& operator/=(const Dual& b) { return *this = *this / b; }

    friend Dual operator+(Dual a, const Dual& b) { return a += b; }
    friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
    friend Dual operator*(const Dual& a, const Dual& b) {
        return {Scalar(a.value * b.value), a.value * b.tangent + b.value * a.tangent};
    }
    friend Dual operator/(const Dual& a, const Dual& b) {
        // (a/b)′ = (a′ − (a/b) b′) / b
        const Scalar ratio = a.value / b.value;
        return {ratio, (a.tangent - ratio * b.tangent) / b.value};
    }
    friend Dual operator+(const Dual& a) { return a; }
    friend Dual operator-(const Dual& a) { return {Scalar(-a.value), -a.tangent}; }

    friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
    friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
    friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }
    friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
    friend bool operator>=(const Dual& a, const Dual& b) { return a.value >= b.value; }

    // f(a)′ = f′(a) a′

    friend Dual sin(const Dual& a) { return SinCos<Dual>(a).sin; }
    friend Dual cos(const Dual& a) { return SinCos<Dual>(a).cos; }
    friend Dual abs(const Dual& a) { return a.value < Scalar(0) ? -a : a; }

    /// at 0, where the slope is infinite, a constant remains a constant
    friend Dual sqrt(const Dual& a) {
        using std::sqrt;
        const Scalar root = sqrt(a.value);
        return a.varies() ? Dual{root, a.tangent / Scalar(Scalar(2) * root)} : Dual(root);
    }
    bool varies() const { return (tangent.array() != Scalar(0)).any(); }
};

template <class Scalar, int N>
struct SinCos<Dual<Scalar, N>> {
    Dual<Scalar, N> sin, cos;

    explicit SinCos(const Dual<Scalar, N>& angle) {
        const SinCos<Scalar> of(angle.value);
        sin = {of.sin, of.cos * angle.tangent};
        cos = {of.cos, Scalar(-of.sin) * angle.tangent};
    }
};

}  // namespace doppel

/// Range and precision are those of its value.
template <class Scalar, int N>
struct std::numeric_limits<doppel::Dual<Scalar, N>> : std::numeric_limits<Scalar> {};

template <class Scalar, int N>
struct Eigen::NumTraits<doppel::Dual<Scalar, N>> : Eigen::GenericNumTraits<doppel::Dual<Scalar, N>> {
    enum {
        ReadCost = (1 + N) * NumTraits<Scalar>::ReadCost,
        AddCost = (1 + N) * NumTraits<Scalar>::AddCost,
        MulCost = (1 + 2 * N) * NumTraits<Scalar>::MulCost
    };
};

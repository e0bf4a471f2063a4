#pragma once

#include "base/error.hpp"
#include "integrate/taylor_series.hpp"
#include "physics/mechanism_assembly.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// sum ← sum + one · p for particle a, − other · p for what is at b
template <class Scalar, class Vector>
void add_to_ends(std::size_t a, const End<Scalar>& b, const Place<Scalar>& p, const Scalar& one, const Scalar& other,
                 Vector& sum) {
    const auto i = 2 * static_cast<Eigen::Index>(a);
    sum[i] += one * p[0];
    sum[i + 1] += one * p[1];
    if (const auto* particle = std::get_if<std::size_t>(&b)) {
        const auto j = 2 * static_cast<Eigen::Index>(*particle);
        sum[j] -= other * p[0];
        sum[j + 1] -= other * p[1];
    }
}

/// The series of r = q_a − q_b, from a particle a back to another or to a fixed place.
template <class Scalar>
class SeparationSeries {
public:
    SeparationSeries(std::size_t a, const End<Scalar>& b, int terms)
        : a_(a), b_(b), x_(static_cast<std::size_t>(terms), Scalar(0)), y_(x_) {}

    /// r_0 of the places q, m
    template <class Vector>
    void start(const Vector& q) {
        set(0, part_of(q, a_) - place_of(b_, q));
    }

    /// r_k, k > 0, of the coefficients k of all places
    template <class Vector>
    void take(int k, const Vector& q) {
        set(k, part_of(q, a_) - velocity_of(b_, q));
    }

    /// Σ_{j=1}^{n−1} r_j · r_{n−j}, n ≥ 1
    Scalar inner_square(int n) const {
        const Scalar *x = x_.data(), *y = y_.data();
        Scalar across(0), up(0);
        for (int j = 1; 2 * j < n; ++j) {
            across += x[j] * x[n - j];
            up += y[j] * y[n - j];
        }
        const Scalar half = across + up;
        const Scalar sum = half + half;
        return n % 2 == 1 ? sum : Scalar(sum + (x[n / 2] * x[n / 2] + y[n / 2] * y[n / 2]));
    }

    /// Coefficient n of |r|²
    Scalar square(int n) const {
        const Scalar ends = x_[0] * x_[index(n)] + y_[0] * y_[index(n)];
        return n == 0 ? ends : Scalar(inner_square(n) + (ends + ends));
    }

    /// Σ_{j=first}^k r_j c_{k−j}
    Place<Scalar> product(const std::vector<Scalar>& c, int first, int k) const {
        const Scalar *x = x_.data(), *y = y_.data(), *end = c.data() + k;
        Scalar across(0), up(0);
        for (int j = first; j <= k; ++j) {
            across += x[j] * end[-j];
            up += y[j] * end[-j];
        }
        return {across, up};
    }

    /// sum ← sum + one · p for particle a, − other · p for what is at b
    template <class Vector>
    void add(const Place<Scalar>& p, const Scalar& one, const Scalar& other, Vector& sum) const {
        add_to_ends(a_, b_, p, one, other, sum);
    }

private:
    static std::size_t index(int k) { return static_cast<std::size_t>(k); }
    void set(int k, const Place<Scalar>& r) {
        x_[index(k)] = r[0];
        y_[index(k)] = r[1];
    }

    std::size_t a_;
    End<Scalar> b_;
    std::vector<Scalar> x_, y_;
};

/// What multiplies a vector on a particle, or 0 for a fixed place.
template <class Scalar, class Vector>
Scalar share_of(const End<Scalar>& end, const Vector& all) {
    const auto* particle = std::get_if<std::size_t>(&end);
    return particle ? all[static_cast<Eigen::Index>(*particle)] : Scalar(0);
}

/// A force along r = q_a − q_b that depends on s = |r|² and its rate,
///     F_a = −f r ,   f = steady + factor s^α + damping s′/2s ,
/// as a series. With u = s^α and v = s′/2s, of s u′ = α s′ u and s v = ½ s′ coefficient k is
///     s_0 u_k = Σ_{j=1}^k ((α + 1) j/k − 1) s_j u_{k−j} ,     s_0 v_k = ½ (k + 1) s_{k+1} − Σ_{j=1}^k s_j v_{k−j} .
/// Source  Jorba & Zou 2005, Experimental Mathematics 14:99, §2.1.
template <class Scalar>
class CentralForceSeries {
public:
    struct Law {
        Scalar steady, factor;
        bool cube;  // α = −3/2, else −1/2
        Scalar damping;
    };

    /// The force moves a by `share_a` F_a, and what is at b by −`share_b` F_a.
    CentralForceSeries(std::string name, const Law& law, std::size_t a, const End<Scalar>& b, const Scalar& share_a,
                       const Scalar& share_b, int order)
        : name_(std::move(name)),
          law_(law),
          share_a_(share_a),
          share_b_(share_b),
          is_linear_(law.factor == Scalar(0) && law.damping == Scalar(0)),
          r_(a, b, order + 2),
          square_(static_cast<std::size_t>(order + 2), Scalar(0)),
          weighted_(square_),
          power_(square_),
          rate_(square_),
          f_(square_) {}

    /// Throws Error (exit 3) where the ends have met and the force has no direction.
    template <class Vector>
    void start(const Vector& q) {
        r_.start(q);
        square_[0] = r_.square(0);
        if (is_linear_) return;
        if (square_[0] == Scalar(0))
            throw method_failed("{}: its ends have met, where it has no direction; start so that they do not", name_);
        inverse_ = Scalar(1) / square_[0];
    }
    template <class Vector>
    void take(int k, const Vector& q) {
        r_.take(k, q);
    }

    /// a ← a + coefficient k of the accelerations, from places to k + 1
    template <class Vector>
    void accelerate(int k, Vector& a) {
        find(k);
        const Place<Scalar> p = is_linear_ ? Place<Scalar>(r_.product(f_, k, k)) : r_.product(f_, 0, k);
        r_.add(p, -share_a_, -share_b_, a);
    }

    bool attracts() const { return law_.cube; }

    /// |r| at the start, m
    double distance() const { return std::sqrt(plain_value(square_[0])); }

    /// What coefficient k of f gives to that of the accelerations, m/s^(2+k)
    double strength(int k) const {
        const double share = std::max(plain_value(share_a_), plain_value(share_b_));
        return std::abs(share * plain_value(f_[static_cast<std::size_t>(k)])) * distance();
    }

private:
    /// f_k
    void find(int k) {
        const auto n = static_cast<std::size_t>(k);
        f_[n] = k == 0 ? law_.steady : Scalar(0);
        if (is_linear_) return;
        square_[n + 1] = r_.square(k + 1);
        weighted_[n + 1] = Scalar(k + 1) * square_[n + 1];
        if (law_.factor != Scalar(0)) f_[n] += law_.factor * (power_[n] = next_power(k));
        if (law_.damping != Scalar(0)) f_[n] += law_.damping * (rate_[n] = next_rate(k));
    }

    Scalar next_power(int k) const {
        using std::sqrt;
        if (k == 0) return law_.cube ? Scalar(inverse_ * sqrt(inverse_)) : Scalar(sqrt(inverse_));
        const Scalar *s = square_.data(), *js = weighted_.data(), *u = power_.data() + k;
        Scalar sum(0), weighted(0);
        for (int j = 1; j <= k; ++j) {
            sum += s[j] * u[-j];
            weighted += js[j] * u[-j];
        }
        weighted /= Scalar(law_.cube ? -2 * k : 2 * k);
        return (weighted - sum) * inverse_;
    }

    Scalar next_rate(int k) const {
        const Scalar *s = square_.data(), *v = rate_.data() + k;
        Scalar sum = Scalar(0.5) * weighted_[static_cast<std::size_t>(k + 1)];
        for (int j = 1; j <= k; ++j) sum -= s[j] * v[-j];
        return sum * inverse_;
    }

    std::string name_;
    Law law_;
    Scalar share_a_, share_b_;
    bool is_linear_;  // f is steady: no direction is needed
    SeparationSeries<Scalar> r_;
    Scalar inverse_ = Scalar(0);             // 1/s_0
    std::vector<Scalar> square_, weighted_;  // s_k, k s_k
    std::vector<Scalar> power_, rate_, f_;   // u_k, v_k, f_k
};

}  // namespace doppel

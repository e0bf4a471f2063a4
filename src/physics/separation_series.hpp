#pragma once

#include "physics/constraint.hpp"

#include <vector>

namespace doppel {

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
        const auto i = 2 * static_cast<Eigen::Index>(a_);
        sum[i] += one * p[0];
        sum[i + 1] += one * p[1];
        if (const auto* particle = std::get_if<std::size_t>(&b_)) {
            const auto j = 2 * static_cast<Eigen::Index>(*particle);
            sum[j] -= other * p[0];
            sum[j + 1] -= other * p[1];
        }
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

}  // namespace doppel

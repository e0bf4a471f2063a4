#pragma once

#include "integrate/force_series.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace doppel {

/// The series of r and λ of all rods of a mechanism, to order `order` + 1 and `order` − 1, and their products. Rods lie in
/// blocks, in each order by order: the compiler puts neighbours side by side in registers, each with sums of its own.
template <class Scalar>
class RodBundle {
public:
    explicit RodBundle(int order) : terms_(static_cast<std::size_t>(order + 2)) {}

    /// A rod, whose λ moves a by `share_a`, and what is at b by `share_b`.
    void add(std::size_t a, const End<Scalar>& b, const Scalar& share_a, const Scalar& share_b, Eigen::Index row) {
        rods_.push_back({a, b, share_a, share_b, row});
        all_.resize((rods_.size() + width - 1) / width * terms_);
    }

    /// r_0 of the places q, m
    template <class Vector>
    void start(const Vector& q) {
        for (std::size_t i = 0; i < rods_.size(); ++i) set(0, i, part_of(q, rods_[i].a) - place_of(rods_[i].b, q));
    }

    /// r_k, k > 0, of the coefficients k of all places
    template <class Vector>
    void take(int k, const Vector& q) {
        for (std::size_t i = 0; i < rods_.size(); ++i) set(k, i, part_of(q, rods_[i].a) - velocity_of(rods_[i].b, q));
    }

    /// a ← a + M⁻¹ Σ_{j=1}^k r_j λ_{k−j}, and ½ (k + 1)(k + 2) Σ_{j=1}^{k+1} r_j · r_{k+2−j} in the rods' rows
    template <class Vector, class Column>
    void multiply(int k, Vector& a, Column& rows) {
        const Scalar factor = Scalar((k + 1) * (k + 2)) * Scalar(0.5);
        for (std::size_t first = 0; first < rods_.size(); first += width) {
            const auto count = std::min(width, rods_.size() - first);
            Term products;
            multiply(&all_[first / width * terms_], k, count, products);
            for (std::size_t i = 0; i < count; ++i) {
                const auto& rod = rods_[first + i];
                const Place<Scalar> pull(products.x[i], products.y[i]);
                add_to_ends(rod.a, rod.b, pull, rod.share_a, rod.share_b, a);
                rows[rod.row] = factor * products.lambda[i];
            }
        }
    }

    /// λ_k
    template <class Column>
    void pull(int k, const Column& lambda) {
        for (std::size_t i = 0; i < rods_.size(); ++i) term(k, i).lambda[i % width] = lambda[rods_[i].row];
    }

private:
    static constexpr std::size_t width = 8;
    struct Rod {
        std::size_t a;
        End<Scalar> b;
        Scalar share_a, share_b;
        Eigen::Index row;
    };
    /// Coefficients of one order of a block of rods.
    struct Term {
        std::array<Scalar, width> x{}, y{}, lambda{};
    };

    Term& term(int k, std::size_t rod) { return all_[rod / width * terms_ + static_cast<std::size_t>(k)]; }
    void set(int k, std::size_t rod, const Place<Scalar>& r) {
        term(k, rod).x[rod % width] = r[0];
        term(k, rod).y[rod % width] = r[1];
    }

    /// Σ_{j=1}^k r_j λ_{k−j}, and Σ_{j=1}^{k+1} r_j · r_{k+2−j} in place of λ.
    static void multiply(const Term* term, int k, std::size_t count, Term& products) {
        auto& [x, y, square] = products;
        for (int j = 1; j <= k; ++j)
            for (std::size_t i = 0; i < count; ++i) {
                x[i] += term[j].x[i] * term[k - j].lambda[i];
                y[i] += term[j].y[i] * term[k - j].lambda[i];
            }
        const int n = k + 2;
        std::array<Scalar, width> across{}, up{};
        for (int j = 1; 2 * j < n; ++j)
            for (std::size_t i = 0; i < count; ++i) {
                across[i] += term[j].x[i] * term[n - j].x[i];
                up[i] += term[j].y[i] * term[n - j].y[i];
            }
        for (std::size_t i = 0; i < count; ++i) {
            const Scalar half = across[i] + up[i];
            square[i] = half + half;
            if (n % 2 == 0) square[i] += term[n / 2].x[i] * term[n / 2].x[i] + term[n / 2].y[i] * term[n / 2].y[i];
        }
    }

    std::size_t terms_;
    std::vector<Rod> rods_;
    std::vector<Term> all_;
};

}  // namespace doppel

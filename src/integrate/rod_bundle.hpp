#pragma once

#include "integrate/force_series.hpp"
#include "numeric/lanes.hpp"

#include <array>
#include <type_traits>
#include <vector>

namespace doppel {

/// The series of r and λ of all rods of a mechanism. Products of those of double are formed for eight rods side by side,
/// each with sums of its own.
template <class Scalar>
class RodBundle {
public:
    /// Series of r to order `order` + 1, of λ to `order` − 1.
    explicit RodBundle(int order) : terms_(order + 2) {}

    /// A rod, whose λ moves a by `share_a`, and what is at b by `share_b`.
    void add(std::size_t a, const End<Scalar>& b, const Scalar& share_a, const Scalar& share_b, Eigen::Index row) {
        if (rods_.size() % width == 0) all_.resize(all_.size() + static_cast<std::size_t>(terms_));
        rods_.push_back({a, b, share_a, share_b, row});
        products_.resize(all_.size() / static_cast<std::size_t>(terms_));
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
        for (std::size_t b = 0; b < products_.size(); ++b)
            multiply(&all_[b * static_cast<std::size_t>(terms_)], k, products_[b]);
        const Scalar factor = Scalar((k + 1) * (k + 2)) * Scalar(0.5);
        for (std::size_t i = 0; i < rods_.size(); ++i) {
            const auto& rod = rods_[i];
            const auto& product = products_[i / width];
            const auto lane = i % width;
            add_to_ends(rod.a, rod.b, Place<Scalar>(product.x[lane], product.y[lane]), rod.share_a, rod.share_b, a);
            rows[rod.row] = factor * product.square[lane];
        }
    }

    /// λ_k
    template <class Column>
    void pull(int k, const Column& lambda) {
        for (std::size_t i = 0; i < rods_.size(); ++i) term(k, i).lambda[i % width] = lambda[rods_[i].row];
    }

private:
    static constexpr std::size_t width = std::is_same_v<Scalar, double> ? 8 : 1;
    using Pack = std::conditional_t<width == 1, Scalar, Lanes<static_cast<int>(width)>>;
    using Row = std::array<Scalar, width>;

    struct Rod {
        std::size_t a;
        End<Scalar> b;
        Scalar share_a, share_b;
        Eigen::Index row;
    };
    /// Coefficients of one order.
    struct Term {
        Row x{}, y{}, lambda{};
    };
    struct Products {
        Row x{}, y{};  // Σ r_j λ_{k−j}
        Row square{};  // Σ r_j · r_{k+2−j}
    };

    static Pack load(const Row& row) {
        if constexpr (width == 1)
            return row[0];
        else
            return Pack::load(row.data());
    }
    static void store(const Pack& side, Row& row) {
        if constexpr (width == 1)
            row[0] = side;
        else
            side.store(row.data());
    }

    static void multiply(const Term* term, int k, Products& products) {
        Pack x(0), y(0);
        for (int j = 1; j <= k; ++j) {
            const Pack lambda = load(term[k - j].lambda);
            x += load(term[j].x) * lambda;
            y += load(term[j].y) * lambda;
        }
        store(x, products.x);
        store(y, products.y);

        const int n = k + 2;
        x = y = Pack(0);
        for (int j = 1; 2 * j < n; ++j) {
            x += load(term[j].x) * load(term[n - j].x);
            y += load(term[j].y) * load(term[n - j].y);
        }
        const Pack half = x + y;
        Pack square = half + half;
        if (n % 2 == 0) {
            const Pack middle_x = load(term[n / 2].x), middle_y = load(term[n / 2].y);
            square += middle_x * middle_x + middle_y * middle_y;
        }
        store(square, products.square);
    }

    Term& term(int k, std::size_t rod) {
        return all_[rod / width * static_cast<std::size_t>(terms_) + static_cast<std::size_t>(k)];
    }
    void set(int k, std::size_t rod, const Place<Scalar>& r) {
        term(k, rod).x[rod % width] = r[0];
        term(k, rod).y[rod % width] = r[1];
    }

    int terms_;
    std::vector<Rod> rods_;
    std::vector<Term> all_;  // eight rods by eight, in each order by order
    std::vector<Products> products_;
};

}  // namespace doppel

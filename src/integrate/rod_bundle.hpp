#pragma once

#include "integrate/force_series.hpp"
#include "numeric/lanes.hpp"

#include <array>
#include <type_traits>
#include <vector>

namespace doppel {

/// The series of r and λ of rods, and their products: of `width` rods side by side, each with sums of its own.
template <class Scalar, std::size_t width = std::is_same_v<Scalar, double> ? 8 : 1>
class RodProducts {
public:
    /// Series of r to order `order` + 1, of λ to `order` − 1, all 0.
    explicit RodProducts(int order, std::size_t rods = 0) : terms_(order + 2) { resize(rods); }

    void resize(std::size_t rods) {
        products_.resize((rods + width - 1) / width);
        all_.resize(products_.size() * static_cast<std::size_t>(terms_));
    }

    void set_rod(int k, std::size_t rod, const Scalar& x, const Scalar& y) {
        term(k, rod).x[rod % width] = x;
        term(k, rod).y[rod % width] = y;
    }
    void set_pull(int k, std::size_t rod, const Scalar& lambda) { term(k, rod).lambda[rod % width] = lambda; }

    /// The products of order k, from all r to k + 1 and all λ to k − 1.
    void multiply(int k) {
        for (std::size_t b = 0; b < products_.size(); ++b)
            multiply(&all_[b * static_cast<std::size_t>(terms_)], k, products_[b]);
    }
    /// Σ_{j=1}^k r_j λ_{k−j}
    Place<Scalar> pull(std::size_t rod) const {
        const auto& product = products_[rod / width];
        return {product.x[rod % width], product.y[rod % width]};
    }
    /// Σ_{j=1}^{k+1} r_j · r_{k+2−j}
    const Scalar& square(std::size_t rod) const { return products_[rod / width].square[rod % width]; }

private:
    using Pack = std::conditional_t<width == 1, Scalar, Lanes<static_cast<int>(width)>>;
    using Row = std::array<Scalar, width>;

    /// Coefficients of one order.
    struct Term {
        Row x{}, y{}, lambda{};
    };
    struct Products {
        Row x{}, y{}, square{};
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
    int terms_;
    std::vector<Term> all_;  // `width` rods by `width`, in each order by order
    std::vector<Products> products_;
};

/// The series of r and λ of all rods of a mechanism.
template <class Scalar>
class RodBundle {
public:
    explicit RodBundle(int order) : products_(order) {}

    /// A rod, whose λ moves a by `share_a`, and what is at b by `share_b`.
    void add(std::size_t a, const End<Scalar>& b, const Scalar& share_a, const Scalar& share_b, Eigen::Index row) {
        rods_.push_back({a, b, share_a, share_b, row});
        products_.resize(rods_.size());
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
        products_.multiply(k);
        const Scalar factor = Scalar((k + 1) * (k + 2)) * Scalar(0.5);
        for (std::size_t i = 0; i < rods_.size(); ++i) {
            const auto& rod = rods_[i];
            add_to_ends(rod.a, rod.b, products_.pull(i), rod.share_a, rod.share_b, a);
            rows[rod.row] = factor * products_.square(i);
        }
    }

    /// λ_k
    template <class Column>
    void pull(int k, const Column& lambda) {
        for (std::size_t i = 0; i < rods_.size(); ++i) products_.set_pull(k, i, lambda[rods_[i].row]);
    }

private:
    struct Rod {
        std::size_t a;
        End<Scalar> b;
        Scalar share_a, share_b;
        Eigen::Index row;
    };

    void set(int k, std::size_t rod, const Place<Scalar>& r) { products_.set_rod(k, rod, r[0], r[1]); }

    std::vector<Rod> rods_;
    RodProducts<Scalar> products_;
};

}  // namespace doppel

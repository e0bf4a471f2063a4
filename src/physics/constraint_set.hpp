#pragma once

#include "numeric/envelope_matrix.hpp"
#include "physics/constraint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace doppel {

/// The constraints of a mechanism, and what their J = ∂C/∂q does to vectors. Which entries of J differ from zero is
/// found once; their values, a gradient for every particle that a row ties, are the caller's to keep. Rows come in the
/// order of the constraints: J M⁻¹ Jᵀ is narrow where neighbours are listed one after the other.
template <class Scalar>
class ConstraintSet {
public:
    using Column = State<Scalar, Eigen::Dynamic>;
    using Gradients = std::vector<Place<Scalar>>;  // ∂C_row/∂q_particle, one a block

    /// Of particles that now are at q.
    explicit ConstraintSet(const std::vector<Constraint<Scalar>>& constraints, const Column& q)
        : constraints_(constraints) {
        Eigen::Index row = 0;
        for (std::size_t c = 0; c < constraints_.size(); ++c)
            std::visit(
                [&](const auto& part) {
                    part.gradient(q, [&](Eigen::Index nth, std::size_t particle, const Place<Scalar>&) {
                        blocks_.push_back({row + nth, static_cast<Eigen::Index>(particle)});
                    });
                    owner_.insert(owner_.end(), part.rows, c);
                    row += static_cast<Eigen::Index>(part.rows);
                },
                constraints_[c]);
        std::vector<std::vector<std::size_t>> of_particle(static_cast<std::size_t>(q.size() / 2));
        const auto neighbours = [&](std::size_t k) -> auto& {
            return of_particle[static_cast<std::size_t>(blocks_[k].particle)];
        };
        for (std::size_t k = 0; k < blocks_.size(); ++k) neighbours(k).push_back(k);
        for (std::size_t k = 0; k < blocks_.size(); ++k)
            for (const auto l : neighbours(k)) couples_.push_back({k, l});
        for (const auto& constraint : constraints_) {
            if (const auto place = fixed_place_of(constraint))
                farthest_fixed_ = std::max(farthest_fixed_, Scalar(place->cwiseAbs().maxCoeff()));
            if (const auto rod = rod_of(constraint)) longest_rod_ = std::max(longest_rod_, rod->length);
        }
    }

    Eigen::Index rows() const { return static_cast<Eigen::Index>(owner_.size()); }

    /// The constraint that a row belongs to.
    std::size_t owner(Eigen::Index row) const { return owner_[static_cast<std::size_t>(row)]; }

    const Constraint<Scalar>& operator[](std::size_t constraint) const { return constraints_[constraint]; }

    /// A J M⁻¹ Jᵀ of zeros, wide enough for what couple() puts into it.
    EnvelopeMatrix<Scalar> blank_matrix() const {
        std::vector<Eigen::Index> begin(static_cast<std::size_t>(rows()));
        std::iota(begin.begin(), begin.end(), 0);
        for (const auto& [first, second] : couples_) {
            const auto [low, high] = std::minmax({blocks_[first].row, blocks_[second].row});
            auto& of_high = begin[static_cast<std::size_t>(high)];
            of_high = std::min(of_high, low);
        }
        return EnvelopeMatrix<Scalar>(begin);
    }
    Gradients blank_gradients() const { return Gradients(blocks_.size(), Place<Scalar>(Scalar(0), Scalar(0))); }

    /// c ← C(q)
    template <class Vector>
    void value(const Vector& q, Column& c) const {
        fill(c, [&](const auto& part) { return part.value(q); });
    }

    /// s ← J̇ v
    template <class Vector>
    void jdot_v(const Vector& v, Column& s) const {
        fill(s, [&](const auto& part) { return part.jdot_v(v); });
    }

    /// How far the constraint that is furthest from being met is from it, m.
    template <class Vector>
    Scalar worst_error(const Vector& q) const {
        Scalar worst(0);
        for (const auto& constraint : constraints_) {
            const Scalar error = std::visit([&](const auto& part) { return Scalar(part.error(q)); }, constraint);
            if (!(error <= worst)) worst = error;  // NaN counts as worst
        }
        return worst;
    }

    /// The longest rod or radius, m; 0 where all constraints are straight.
    const Scalar& longest_rod() const { return longest_rod_; }

    /// c ← ε |q| Σ_j |J_ij|, with the largest coordinate that there is, of particles and fixed places
    template <class Vector>
    void rounding(const Gradients& gradients, const Vector& q, Column& c) const {
        using std::abs;
        c.setZero();
        for (std::size_t k = 0; k < blocks_.size(); ++k)
            c[blocks_[k].row] += abs(gradients[k][0]) + abs(gradients[k][1]);
        c *=
            Scalar(std::numeric_limits<Scalar>::epsilon()) * std::max(farthest_fixed_, Scalar(q.cwiseAbs().maxCoeff()));
    }

    /// gradients ← J(q)
    template <class Vector>
    void update(const Vector& q, Gradients& gradients) const {
        auto next = gradients.begin();
        for (const auto& constraint : constraints_)
            std::visit(
                [&](const auto& part) {
                    part.gradient(q, [&](Eigen::Index, std::size_t, const Place<Scalar>& g) { *next++ = g; });
                },
                constraint);
    }

    /// s ← s + J v
    template <class Vector>
    void add_constraint_velocity(const Gradients& gradients, const Vector& v, Column& s) const {
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto i = 2 * blocks_[k].particle;
            s[blocks_[k].row] += gradients[k][0] * v[i] + gradients[k][1] * v[i + 1];
        }
    }

    /// v ← v + M⁻¹ Jᵀ λ, with the inverse masses w
    template <class Vector>
    void add_pull(const Gradients& gradients, const Column& w, const Column& lambda, Vector& v) const {
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto i = blocks_[k].particle;
            const Scalar share = w[i] * lambda[blocks_[k].row];
            v[2 * i] += share * gradients[k][0];
            v[2 * i + 1] += share * gradients[k][1];
        }
    }

    /// The forces in the rods, N, > 0 where one pulls: λ r acts on its particle a, where r is its first gradient.
    std::vector<Scalar> tensions(const Gradients& gradients, const Column& lambda) const {
        using std::sqrt;
        std::vector<Scalar> all;
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto row = blocks_[k].row;
            const bool first = k == 0 || blocks_[k - 1].row != row;
            if (!first || !std::holds_alternative<Rod<Scalar>>(constraints_[owner(row)])) continue;
            const auto& r = gradients[k];
            all.push_back(-lambda[row] * sqrt(Scalar(r[0] * r[0] + r[1] * r[1])));
        }
        return all;
    }

    /// matrix ← J1 M⁻¹ J0ᵀ, with the inverse masses w
    void couple(const Gradients& one, const Gradients& zero, const Column& w, EnvelopeMatrix<Scalar>& matrix) const {
        matrix.clear();
        for (const auto& [first, second] : couples_) {
            const auto &g1 = one[first], &g0 = zero[second];
            matrix(blocks_[first].row, blocks_[second].row) +=
                w[blocks_[first].particle] * (g1[0] * g0[0] + g1[1] * g0[1]);
        }
    }

private:
    /// What is not zero in J.
    struct Block {
        Eigen::Index row, particle;
    };
    /// Two blocks of one particle: together they add to an entry of J M⁻¹ Jᵀ.
    struct Couple {
        std::size_t first, second;
    };

    /// The values that `ask` gives for every constraint, one a row.
    template <class Ask>
    void fill(Column& values, const Ask& ask) const {
        Eigen::Index row = 0;
        for (const auto& constraint : constraints_)
            std::visit(
                [&](const auto& part) {
                    for (const auto& value : ask(part)) values[row++] = value;
                },
                constraint);
    }

    std::vector<Constraint<Scalar>> constraints_;
    std::vector<std::size_t> owner_;  // of each row
    std::vector<Block> blocks_;
    std::vector<Couple> couples_;
    Scalar farthest_fixed_ = Scalar(0), longest_rod_ = Scalar(0);  // m
};

}  // namespace doppel

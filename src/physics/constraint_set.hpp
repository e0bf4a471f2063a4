#pragma once

#include "numeric/solvers.hpp"
#include "physics/constraint.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace doppel {

/// The constraints of a mechanism, and products of their J = ∂C/∂q with vectors. The sparsity of J is found once. Its
/// values, a gradient for each particle of a row, are stored by the caller. Rows are in the order of the constraints: J
/// M⁻¹ Jᵀ has a small envelope if neighbours are listed one after the other.
template <class Scalar>
class ConstraintSet {
public:
    using Column = State<Scalar, Eigen::Dynamic>;
    using Gradients = std::vector<Place<Scalar>>;  // ∂C_row/∂q_particle, one for each block

    /// For particles with these inverse masses, 1/kg.
    ConstraintSet(const std::vector<Constraint<Scalar>>& constraints, const Column& inverse_masses)
        : w_(inverse_masses) {
        std::vector<std::vector<std::size_t>> of_particle(static_cast<std::size_t>(w_.size()));
        const auto add = [&](std::size_t particle) {
            of_particle[particle].push_back(blocks_.size());
            blocks_.push_back({static_cast<Eigen::Index>(rows_.size()), static_cast<Eigen::Index>(particle)});
        };
        for (std::size_t c = 0; c < constraints.size(); ++c)
            for (const auto& row : rows_of(constraints[c])) {
                add(row.a);
                if (const auto* other = row.other_particle())
                    add(*other);
                else
                    farthest_fixed_ =
                        std::max(farthest_fixed_, Scalar(std::get<Place<Scalar>>(row.b).cwiseAbs().maxCoeff()));
                longest_rod_ = std::max(longest_rod_, row.length);
                rows_.push_back(row);
                owner_.push_back(c);
            }
        for (std::size_t k = 0; k < blocks_.size(); ++k)
            for (const auto l : of_particle[static_cast<std::size_t>(blocks_[k].particle)]) couples_.push_back({k, l});
        scratch_ = blank_gradients();
    }

    Eigen::Index constraints() const { return static_cast<Eigen::Index>(rows_.size()); }

    std::size_t owner(Eigen::Index row) const { return owner_[static_cast<std::size_t>(row)]; }

    /// The longest rod or radius, m; 0 if all constraints are straight.
    const Scalar& longest_rod() const { return longest_rod_; }

    /// A zero matrix with the envelope of J M⁻¹ Jᵀ.
    EnvelopeMatrix<Scalar> blank_matrix() const {
        std::vector<Eigen::Index> begin(rows_.size());
        std::iota(begin.begin(), begin.end(), 0);
        for (const auto& [first, second] : couples_) {
            const auto [low, high] = std::minmax({blocks_[first].row, blocks_[second].row});
            auto& of_high = begin[static_cast<std::size_t>(high)];
            of_high = std::min(of_high, low);
        }
        return EnvelopeMatrix<Scalar>(begin);
    }
    Gradients blank_gradients() const { return Gradients(blocks_.size(), Place<Scalar>(Scalar(0), Scalar(0))); }

    /// gradients ← J(q)
    template <class Vector>
    void update(const Vector& q, Gradients& gradients) const {
        auto next = gradients.begin();
        for (const auto& row : rows_) {
            const Place<Scalar> gradient = row.gradient(q);
            *next++ = gradient;
            if (row.other_particle()) *next++ = -gradient;
        }
    }
    /// matrix ← J1 M⁻¹ J0ᵀ
    void couple(const Gradients& one, const Gradients& zero, EnvelopeMatrix<Scalar>& matrix) const {
        matrix.clear();
        for (const auto& [first, second] : couples_)
            matrix(blocks_[first].row, blocks_[second].row) +=
                w_[blocks_[first].particle] * inner(one[first], zero[second]);
    }
    /// s ← s + J v
    template <class Vector>
    void add_constraint_velocity(const Gradients& gradients, const Vector& v, Column& s) const {
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto i = 2 * blocks_[k].particle;
            s[blocks_[k].row] += gradients[k][0] * v[i] + gradients[k][1] * v[i + 1];
        }
    }
    /// v ← v + M⁻¹ Jᵀ λ
    template <class Vector>
    void add_multipliers(const Gradients& gradients, const Column& lambda, Vector& v) const {
        for (std::size_t k = 0; k < blocks_.size(); ++k) {
            const auto i = blocks_[k].particle;
            const Scalar share = w_[i] * lambda[blocks_[k].row];
            v[2 * i] += share * gradients[k][0];
            v[2 * i + 1] += share * gradients[k][1];
        }
    }

    // Of the concept Constrained.

    void residual(const Column& q, Column& c) const {
        for (std::size_t i = 0; i < rows_.size(); ++i) c[static_cast<Eigen::Index>(i)] = rows_[i].value(q);
    }
    template <class Vector>
    void jdot_v(const Vector&, const Vector& v, Column& s) const {
        for (std::size_t i = 0; i < rows_.size(); ++i) s[static_cast<Eigen::Index>(i)] = rows_[i].jdot_v(v);
    }
    void rounding(const Column& q, Column& c) {
        using std::abs;
        update(q, scratch_);
        c.setZero();
        for (std::size_t k = 0; k < blocks_.size(); ++k) c[blocks_[k].row] += abs(scratch_[k][0]) + abs(scratch_[k][1]);
        c *=
            Scalar(std::numeric_limits<Scalar>::epsilon()) * std::max(farthest_fixed_, Scalar(q.cwiseAbs().maxCoeff()));
    }
    void constraint_velocity(const Column& q, const Column& v, Column& s) {
        update(q, scratch_);
        s.setZero();
        add_constraint_velocity(scratch_, v, s);
    }
    void apply_multipliers(const Column& q, const Column& lambda, Column& v) {
        update(q, scratch_);
        add_multipliers(scratch_, lambda, v);
    }

protected:
    Gradients scratch_;

private:
    /// A nonzero block of J.
    struct Block {
        Eigen::Index row, particle;
    };
    /// Two blocks of the same particle, whose product is a term of an entry of J M⁻¹ Jᵀ.
    struct Couple {
        std::size_t first, second;
    };

    Column w_;  // inverse masses, 1/kg
    std::vector<ConstraintRow<Scalar>> rows_;
    std::vector<std::size_t> owner_;  // for each row
    std::vector<Block> blocks_;
    std::vector<Couple> couples_;
    Scalar farthest_fixed_ = Scalar(0), longest_rod_ = Scalar(0);  // m
};

}  // namespace doppel

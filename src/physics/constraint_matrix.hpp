#pragma once

#include "numeric/state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace doppel {

/// A square matrix whose rows each begin at some column and whose columns begin likewise, factored within that
/// envelope without interchanges: O(N) for a chain, O(N³) for a full one.
///
/// For J M⁻¹ Jᵀ no interchange is needed, and without one the pivots have a meaning: pivot i is the squared length of
/// what is left of gradient i beside the gradients before it. One that vanishes names the constraint that depends on
/// others. Source  Golub & Van Loan, Matrix Computations, §4.3; George & Liu, Computer Solution of Large Sparse
/// Positive
///         Definite Systems, §4.
template <class Scalar>
class ConstraintMatrix {
public:
    using Column = State<Scalar, Eigen::Dynamic>;
    using Index = Eigen::Index;

    explicit ConstraintMatrix(Index rows = 0) : entries_(rows, rows), inverse_(rows), begin_(rows) {
        entries_.setZero();
        for (Index i = 0; i < rows; ++i) begin_[static_cast<std::size_t>(i)] = i;
    }

    Index rows() const { return entries_.rows(); }

    /// From now on (i, j) and (j, i) may differ from zero.
    void widen(Index i, Index j) {
        auto& begin = begin_[static_cast<std::size_t>(std::max(i, j))];
        begin = std::min(begin, std::min(i, j));
    }

    void clear() {
        for (Index i = 0; i < rows(); ++i) {
            for (Index j = begin(i); j < i; ++j) entries_(i, j) = entries_(j, i) = Scalar(0);
            entries_(i, i) = Scalar(0);
        }
    }
    Scalar& operator()(Index i, Index j) { return entries_(i, j); }

    /// Replaces the matrix by unit lower times upper. Returns the first row that depends on those before it so closely
    /// that no more than a quarter of the digits would be right (or that holds no number); rows() where there is none.
    Index factor() {
        using std::abs;
        nearly_singular_ = false;
        turned_over_ = rows();
        for (Index i = 0; i < rows(); ++i) {
            const Scalar whole = entries_(i, i);
            for (Index j = begin(i); j < i; ++j) {
                for (Index k = std::max(begin(i), begin(j)); k < j; ++k) {
                    entries_(i, j) -= entries_(i, k) * entries_(k, j);
                    entries_(j, i) -= entries_(j, k) * entries_(k, i);
                }
                entries_(i, j) *= inverse_[j];
            }
            for (Index k = begin(i); k < i; ++k) entries_(i, i) -= entries_(i, k) * entries_(k, i);
            const Scalar& pivot = entries_(i, i);
            if (!(abs(pivot) > smallest_ * abs(whole))) return i;
            if (abs(pivot) * Scalar(20) < abs(whole)) nearly_singular_ = true;
            if (pivot < Scalar(0) && turned_over_ == rows()) turned_over_ = i;
            inverse_[i] = Scalar(1) / pivot;
        }
        return rows();
    }

    /// Whether factor() has seen a pivot less than a twentieth of what stood in its place.
    bool nearly_singular() const { return nearly_singular_; }

    /// The first row whose pivot factor() has found negative; rows() where there is none.
    Index turned_over() const { return turned_over_; }

    /// x ← A⁻¹ x, after factor().
    void solve(Column& x) const {
        for (Index i = 0; i < rows(); ++i)
            for (Index k = begin(i); k < i; ++k) x[i] -= entries_(i, k) * x[k];
        for (Index i = rows() - 1; i >= 0; --i) {
            x[i] *= inverse_[i];
            for (Index k = begin(i); k < i; ++k) x[k] -= entries_(k, i) * x[i];
        }
    }

    /// c with row i = Σ_{j<i} c_j row j as nearly as can be, after factor() has come to row i.
    Column dependence(Index i) const {
        Column c = entries_.row(i).head(i);
        for (Index j = i - 1; j > 0; --j)
            for (Index k = begin(j); k < j; ++k) c[k] -= c[j] * entries_(j, k);
        return c;
    }

private:
    Index begin(Index i) const { return begin_[static_cast<std::size_t>(i)]; }

    /// ε^(3/4)
    static Scalar smallest() {
        using std::sqrt;
        const Scalar half = sqrt(Scalar(std::numeric_limits<Scalar>::epsilon()));
        return half * sqrt(half);
    }

    Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> entries_;
    Column inverse_;            // of the pivots
    std::vector<Index> begin_;  // of row i and of column i
    Scalar smallest_ = smallest();
    bool nearly_singular_ = false;
    Index turned_over_ = 0;
};

}  // namespace doppel

#pragma once

#include "numeric/state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace doppel {

/// A square matrix whose rows each begin at some column and whose columns begin likewise, kept and factored within that
/// envelope without interchanges: O(N) in memory and time for a chain, O(N²) and O(N³) for a full one.
///
/// For J M⁻¹ Jᵀ no interchange is needed, and without one the pivots have a meaning: pivot i is the squared length of
/// what is left of gradient i beside the gradients before it. One that vanishes names the constraint that depends on
/// others.
/// Source  Golub & Van Loan, Matrix Computations, §4.3; George & Liu, Computer Solution of Large Sparse Positive Definite
///         Systems, §4.
template <class Scalar>
class EnvelopeMatrix {
public:
    using Column = State<Scalar, Eigen::Dynamic>;
    using Index = Eigen::Index;

    /// Zeros. Only (i, j) and (j, i) with begin[i] ≤ j ≤ i may differ from zero.
    explicit EnvelopeMatrix(const std::vector<Index>& begin) {
        Index entries = 0;
        for (std::size_t i = 0; i < begin.size(); ++i) {
            const Index row = static_cast<Index>(i);
            envelope_.push_back({begin[i], entries - begin[i]});
            entries += row - begin[i];
        }
        diagonal_ = whole_ = inverse_ = Column::Zero(rows());
        lower_ = upper_ = Column::Zero(entries);
    }

    Index rows() const { return static_cast<Index>(envelope_.size()); }
    Index begin(Index i) const { return envelope_[static_cast<std::size_t>(i)].begin; }
    /// Numbers kept of the matrix itself.
    Index entries() const { return lower_.size() + diagonal_.size() + upper_.size(); }

    void clear() {
        lower_.setZero();
        upper_.setZero();
        diagonal_.setZero();
    }
    Scalar& operator()(Index i, Index j) { return i == j ? diagonal_[i] : i > j ? lower(i, j) : upper(i, j); }

    /// Replaces the matrix by unit lower times upper.
    void factor() {
        whole_ = diagonal_;
        for (Index i = 0; i < rows(); ++i) {
            for (Index j = begin(i); j < i; ++j) {
                for (Index k = std::max(begin(i), begin(j)); k < j; ++k) {
                    lower(i, j) -= lower(i, k) * upper(k, j);
                    upper(j, i) -= lower(j, k) * upper(k, i);
                }
                lower(i, j) *= inverse_[j];
            }
            for (Index k = begin(i); k < i; ++k) diagonal_[i] -= lower(i, k) * upper(k, i);
            inverse_[i] = Scalar(1) / diagonal_[i];
        }
    }

    // Of the factors; rows() where no row is like that.

    /// The first row that depends on those before it so closely that no more than a quarter of the digits would be right (or
    /// that is NaN).
    Index dependent_row() const {
        using std::abs;
        Index i = 0;
        while (i < rows() && abs(diagonal_[i]) > smallest_ * abs(whole_[i])) ++i;
        return i;
    }
    /// The first row whose pivot is negative.
    Index negative_row() const {
        Index i = 0;
        while (i < rows() && !(diagonal_[i] < Scalar(0))) ++i;
        return i;
    }
    /// Whether a pivot is less than a twentieth of what stood in its place.
    bool nearly_singular() const {
        using std::abs;
        for (Index i = 0; i < rows(); ++i)
            if (abs(diagonal_[i]) * Scalar(20) < abs(whole_[i])) return true;
        return false;
    }

    /// x ← A⁻¹ x, after factor().
    void solve(Column& x) const {
        for (Index i = 0; i < rows(); ++i)
            for (Index k = begin(i); k < i; ++k) x[i] -= lower(i, k) * x[k];
        for (Index i = rows() - 1; i >= 0; --i) {
            x[i] *= inverse_[i];
            for (Index k = begin(i); k < i; ++k) x[k] -= upper(k, i) * x[i];
        }
    }

    /// c with row i = Σ_{j<i} c_j row j as nearly as can be, after factor() has come to row i.
    Column dependence(Index i) const {
        Column c = Column::Zero(i);
        for (Index j = begin(i); j < i; ++j) c[j] = lower(i, j);
        for (Index j = i - 1; j > 0; --j)
            for (Index k = begin(j); k < j; ++k) c[k] -= c[j] * lower(j, k);
        return c;
    }

private:
    /// Where row i of the lower half and column i of the upper half begin, and what to add for their places in memory.
    struct Envelope {
        Index begin, offset;
    };

    Index place(Index i, Index k) const { return envelope_[static_cast<std::size_t>(i)].offset + k; }
    Scalar& lower(Index i, Index k) { return lower_[place(i, k)]; }
    Scalar& upper(Index k, Index i) { return upper_[place(i, k)]; }
    const Scalar& lower(Index i, Index k) const { return lower_[place(i, k)]; }
    const Scalar& upper(Index k, Index i) const { return upper_[place(i, k)]; }

    /// ε^(3/4)
    static Scalar smallest() {
        using std::sqrt;
        const Scalar half = sqrt(Scalar(std::numeric_limits<Scalar>::epsilon()));
        return half * sqrt(half);
    }

    std::vector<Envelope> envelope_;
    Column lower_, diagonal_, upper_;  // below the diagonal row by row, above it column by column
    Column whole_, inverse_;           // the diagonal before factor(); 1/pivot
    Scalar smallest_ = smallest();
};

/// x ← A⁻¹ x. On a tape (numeric/tape.hpp) A is not factored.
template <class Scalar>
void solve_factored(EnvelopeMatrix<Scalar>& a, State<Scalar, Eigen::Dynamic>& x) {
    a.solve(x);
}

}  // namespace doppel

#pragma once

#include "numeric/state.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace doppel {

/// The tridiagonal matrix of a chain of N rods, factored and solved in O(N) without pivoting. With inverse masses w_k
/// and coefficients a_k, b_k, b′_k of the rods, row k is
///     −w_{k−1} b′_{k−1} ,    (w_{k−1} + w_k) a_k ,    −w_k b_k       (w_{−1} = 0; the last row ends on the diagonal).
/// It is eliminated from both ends towards the middle, because each division waits for the previous one of its end.
/// With c_k = w_k² (a_k a_{k+1} − b_k b′_k), for rods r_k and r′_k equal to w_k² (r_k × r_{k+1}) (r′_k × r′_{k+1}), the
/// pivots are
///     p_k = w_k a_k + e_k from the top,        e_0 = 0 ,               e_{k+1} = (w_k a_{k+1} e_k + c_k) / p_k ,
///     p_k = w_{k−1} a_k + f_k from the bottom, f_last = w_last a_last, f_k = (w_k a_k f_{k+1} + c_k) / p_{k+1} ,
/// and e + f in the middle. These are sums of positive terms for any masses; subtraction would lose the digits of a
/// light mass between nearly aligned rods.
/// Source  Golub & Van Loan, Matrix Computations, §4.3; from both ends: Babuška 1972, Numerical stability in problems
///         of linear algebra, SIAM J. Numer. Anal. 9:53.
template <class Scalar, int N>
struct ChainMatrix {
    using Column = State<Scalar, N>;

    Column upper;  // −w_k b_k, then the factor; the last element is unused
    Column lower;  // −w_k b′_k, as above

    explicit ChainMatrix(Eigen::Index rows = N) : upper(Column::Zero(rows)), lower(upper), inverse_(upper) {}

    /// Replaces the matrix by its factors. `a(k)` is a_k; `by_first` and `by_last` are 1/p of the first and last row
    /// (both unused in a matrix of one row, `by_last` in one of two).
    template <class Coefficient>
    void factor(const Column& w, const Coefficient& a, const Column& c, const Scalar& by_first, const Scalar& by_last) {
        const auto m = middle(), last = inverse_.size() - 1;
        Scalar e(0), f = w[last] * a(last);
        for (Eigen::Index k = 0; k < m; ++k) {
            inverse_[k] = k == 0 ? by_first : Scalar(Scalar(1) / Scalar(w[k] * a(k) + e));
            lower[k] *= inverse_[k];
            e = k == 0 ? Scalar(c[k] * inverse_[k]) : Scalar((w[k] * a(k + 1) * e + c[k]) * inverse_[k]);
        }
        for (Eigen::Index k = last; k > m; --k) {
            inverse_[k] = k == last ? by_last : Scalar(Scalar(1) / Scalar(w[k - 1] * a(k) + f));
            upper[k - 1] *= inverse_[k];
            f = (w[k - 1] * a(k - 1) * f + c[k - 1]) * inverse_[k];
        }
        inverse_[m] = Scalar(1) / Scalar(e + f);
    }

    /// x ← A⁻¹ x, after factor().
    void solve(Column& x) const {
        const auto n = inverse_.size(), m = middle();
        for (Eigen::Index i = 0; i < m; ++i) x[i + 1] -= lower[i] * x[i];
        for (Eigen::Index i = n - 1; i > m; --i) x[i - 1] -= upper[i - 1] * x[i];
        x[m] *= inverse_[m];
        for (Eigen::Index i = m; i > 0; --i) x[i - 1] = (x[i - 1] - upper[i - 1] * x[i]) * inverse_[i - 1];
        for (Eigen::Index i = m + 1; i < n; ++i) x[i] = (x[i] - lower[i - 1] * x[i - 1]) * inverse_[i];
    }

private:
    /// The row where both eliminations meet.
    Eigen::Index middle() const { return inverse_.size() / 2; }

    Column inverse_;  // of the pivots
};

/// x ← A⁻¹ x, of one or several columns, for a symmetric positive definite A, which needs no pivoting; A is overwritten.
/// For scalars and small matrices for which Eigen's factorisations take seconds to compile.
/// Source  Golub & Van Loan, Matrix Computations, §4.1.
template <class Matrix, class Columns>
void solve_positive_definite(Matrix& a, Columns& x) {
    using Scalar = typename Matrix::Scalar;
    const auto n = a.rows();
    for (Eigen::Index k = 0; k < n; ++k)
        for (Eigen::Index i = k + 1; i < n; ++i) {
            const Scalar factor = a(i, k) / a(k, k);
            for (Eigen::Index j = k + 1; j < n; ++j) a(i, j) -= factor * a(k, j);
            x.row(i) -= factor * x.row(k);
        }
    for (Eigen::Index i = n; i-- > 0;) {
        for (Eigen::Index j = i + 1; j < n; ++j) x.row(i) -= a(i, j) * x.row(j);
        x.row(i) /= a(i, i);
    }
}

/// A square matrix with a symmetric envelope: each row, and the column of the same number, begins at some index. It is
/// stored and factored inside the envelope without pivoting: O(N) in memory and time for a chain, O(N²) and O(N³) for a
/// full matrix.
///
/// J M⁻¹ Jᵀ needs no pivoting, and its pivots have a meaning: pivot i is the squared length of the component of
/// gradient i that is orthogonal to the gradients before it. A zero pivot belongs to a constraint that depends on
/// others.
/// Source  Golub & Van Loan, Matrix Computations, §4.3; George & Liu, Computer Solution of Large Sparse Positive
///         Definite Systems, §4.
template <class Scalar>
class EnvelopeMatrix {
public:
    using Column = State<Scalar, Eigen::Dynamic>;
    using Index = Eigen::Index;

    /// A matrix of zeros. Only (i, j) and (j, i) with begin[i] ≤ j ≤ i may be nonzero.
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
    /// The number of stored entries.
    Index entries() const { return lower_.size() + diagonal_.size() + upper_.size(); }

    void clear() {
        lower_.setZero();
        upper_.setZero();
        diagonal_.setZero();
    }
    Scalar& operator()(Index i, Index j) { return i == j ? diagonal_[i] : i > j ? lower(i, j) : upper(i, j); }

    /// Replaces the matrix by its unit lower and upper factors.
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

    // These refer to the factors; they return rows() if there is no such row.

    /// The first row that is NaN, or so nearly dependent on the rows before it that at most a quarter of the digits
    /// remain.
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
    /// Whether a pivot is less than a twentieth of the diagonal element it replaces.
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

    /// The c for which row i is closest to Σ_{j<i} c_j row j, if factor() has reached row i.
    Column dependence(Index i) const {
        Column c = Column::Zero(i);
        for (Index j = begin(i); j < i; ++j) c[j] = lower(i, j);
        for (Index j = i - 1; j > 0; --j)
            for (Index k = begin(j); k < j; ++k) c[k] -= c[j] * lower(j, k);
        return c;
    }

private:
    /// Where row i of the lower and column i of the upper triangle begin, and the offset to their places in memory.
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

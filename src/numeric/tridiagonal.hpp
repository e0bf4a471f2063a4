#pragma once

#include "numeric/state.hpp"

namespace doppel {

/// A tridiagonal matrix of N rows, factored and solved in O(N) without pivoting: for the positive definite matrices of
/// chains, where none is needed, and their neighbours. It is eliminated from both ends to the middle: every division
/// waits for the one before it, and so half as many wait.
/// Source  Golub & Van Loan, Matrix Computations, §4.3; from both ends: Babuška 1972, Numerical stability in problems
///         of linear algebra, SIAM J. Numer. Anal. 9:53.
template <class Scalar, int N>
struct Tridiagonal {
    using Column = State<Scalar, N>;

    Column diagonal;  // row i, column i
    Column upper;     // row i, column i + 1; the last is unused
    Column lower;     // row i + 1, column i; the last is unused

    explicit Tridiagonal(Eigen::Index rows = N) : diagonal(Column::Zero(rows)), upper(diagonal), lower(diagonal) {}

    /// Replaces the matrix by its factors: the diagonal holds the inverses of the pivots; lower above the middle, and
    /// upper below it, hold what each row is subtracted times from the next.
    void factor() {
        const auto m = middle(), last = diagonal.size() - 1;
        factor(m > 0 ? Scalar(Scalar(1) / diagonal[0]) : Scalar(0),
               m < last ? Scalar(Scalar(1) / diagonal[last]) : Scalar(0));
    }

    /// The same where the inverses of the first and the last entry of the diagonal are known.
    void factor(const Scalar& by_first, const Scalar& by_last) {
        const auto m = middle(), last = diagonal.size() - 1;
        for (Eigen::Index i = 0; i < m; ++i) {
            diagonal[i] = i == 0 ? by_first : Scalar(Scalar(1) / diagonal[i]);
            lower[i] *= diagonal[i];
            diagonal[i + 1] -= lower[i] * upper[i];
        }
        for (Eigen::Index i = last; i > m; --i) {
            diagonal[i] = i == last ? by_last : Scalar(Scalar(1) / diagonal[i]);
            upper[i - 1] *= diagonal[i];
            diagonal[i - 1] -= upper[i - 1] * lower[i - 1];
        }
        diagonal[m] = Scalar(1) / diagonal[m];
    }

    /// x ← A⁻¹ x, after factor().
    void solve(Column& x) const {
        const auto n = diagonal.size(), m = middle();
        for (Eigen::Index i = 0; i < m; ++i) x[i + 1] -= lower[i] * x[i];
        for (Eigen::Index i = n - 1; i > m; --i) x[i - 1] -= upper[i - 1] * x[i];
        x[m] *= diagonal[m];
        for (Eigen::Index i = m; i > 0; --i) x[i - 1] = (x[i - 1] - upper[i - 1] * x[i]) * diagonal[i - 1];
        for (Eigen::Index i = m + 1; i < n; ++i) x[i] = (x[i] - lower[i - 1] * x[i - 1]) * diagonal[i];
    }

private:
    /// The row where both eliminations meet.
    Eigen::Index middle() const { return diagonal.size() / 2; }
};

}  // namespace doppel

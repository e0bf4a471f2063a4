#pragma once

#include "numeric/state.hpp"

namespace doppel {

/// A tridiagonal matrix of N rows, factored and solved in O(N) without pivoting: for the positive definite matrices of
/// chains, where none is needed, and their neighbours.
/// Source  Golub & Van Loan, Matrix Computations, §4.3.
template <class Scalar, int N>
struct Tridiagonal {
    using Column = State<Scalar, N>;

    Column diagonal;  // row i, column i
    Column upper;     // row i, column i + 1; the last is unused
    Column lower;     // row i + 1, column i; the last is unused

    explicit Tridiagonal(Eigen::Index rows = N) : diagonal(Column::Zero(rows)), upper(diagonal), lower(diagonal) {}

    /// Replaces the matrix by its factors, unit lower times upper: the diagonal holds 1/u_ii.
    void factor() {
        const auto n = diagonal.size();
        diagonal[0] = Scalar(1) / diagonal[0];
        for (Eigen::Index i = 1; i < n; ++i) {
            lower[i - 1] *= diagonal[i - 1];
            diagonal[i] = Scalar(1) / (diagonal[i] - lower[i - 1] * upper[i - 1]);
        }
    }

    /// x ← A⁻¹ x, after factor().
    void solve(Column& x) const {
        const auto n = diagonal.size();
        for (Eigen::Index i = 1; i < n; ++i) x[i] -= lower[i - 1] * x[i - 1];
        x[n - 1] *= diagonal[n - 1];
        for (Eigen::Index i = n - 2; i >= 0; --i) x[i] = (x[i] - upper[i] * x[i + 1]) * diagonal[i];
    }
};

}  // namespace doppel

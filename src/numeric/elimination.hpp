#pragma once

#include <Eigen/Core>

namespace doppel {

/// x ← A⁻¹ x for a symmetric positive definite A, which needs no pivoting; A is overwritten. For scalars and small
/// matrices for which Eigen's blocked factorisations take seconds to compile.
/// Source  Golub & Van Loan, Matrix Computations, §4.1.
template <class Matrix, class Column>
void solve_positive_definite(Matrix& a, Column& x) {
    using Scalar = typename Matrix::Scalar;
    const auto n = a.rows();
    for (Eigen::Index k = 0; k < n; ++k)
        for (Eigen::Index i = k + 1; i < n; ++i) {
            const Scalar factor = a(i, k) / a(k, k);
            for (Eigen::Index j = k + 1; j < n; ++j) a(i, j) -= factor * a(k, j);
            x[i] -= factor * x[k];
        }
    for (Eigen::Index i = n; i-- > 0;) {
        for (Eigen::Index j = i + 1; j < n; ++j) x[i] -= a(i, j) * x[j];
        x[i] /= a(i, i);
    }
}

}  // namespace doppel

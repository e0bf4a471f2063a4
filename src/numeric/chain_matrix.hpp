#pragma once

#include "numeric/state.hpp"

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

}  // namespace doppel

#include "numeric/tridiagonal.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace doppel {
namespace tridiagonal_test {

/// Diagonally dominant, not symmetric: as those of chains and their neighbours.
template <int N>
Tridiagonal<double, N> some_matrix(std::mt19937& random, Eigen::Index rows) {
    std::uniform_real_distribution<double> beside(-1, 1), on(2, 4);
    Tridiagonal<double, N> matrix(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
        matrix.diagonal[i] = on(random);
        if (i + 1 == rows) break;
        matrix.upper[i] = beside(random);
        matrix.lower[i] = beside(random);
    }
    return matrix;
}

template <int N>
Eigen::MatrixXd dense(const Tridiagonal<double, N>& matrix) {
    const auto n = matrix.diagonal.size();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
    all.diagonal() = matrix.diagonal;
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
        all(i, i + 1) = matrix.upper[i];
        all(i + 1, i) = matrix.lower[i];
    }
    return all;
}

template <int N>
void expect_solved(Eigen::Index rows) {
    std::mt19937 random(5);
    for (int i = 0; i < 100; ++i) {
        auto matrix = some_matrix<N>(random, rows), ends_known = matrix;
        const auto all = dense(matrix);
        typename Tridiagonal<double, N>::Column x = matrix.upper;
        x.setRandom();
        const Eigen::VectorXd expected = all.partialPivLu().solve(Eigen::VectorXd(x));
        auto again = x;
        matrix.factor();
        matrix.solve(x);
        EXPECT_LT((x - expected).norm(), 2e-15) << rows << " rows";  // measured less than 4e-16

        ends_known.factor(1 / ends_known.diagonal[0], 1 / ends_known.diagonal[rows - 1]);
        ends_known.solve(again);
        EXPECT_EQ(again, x) << rows << " rows";
    }
}

TEST(Tridiagonal, SolvesWhatADenseMatrixDoes) {
    expect_solved<1>(1);
    expect_solved<2>(2);
    expect_solved<3>(3);
    expect_solved<4>(4);
    for (const Eigen::Index rows : {1, 2, 3, 4, 5, 8, 33}) expect_solved<Eigen::Dynamic>(rows);
}

TEST(Tridiagonal, RoundsAlikeWhetherItsRowsAreKnownEarlyOrLate) {
    std::mt19937 random(7);
    const auto early = some_matrix<3>(random, 3);
    Tridiagonal<double, Eigen::Dynamic> late(3);
    late.diagonal = early.diagonal;
    late.upper = early.upper;
    late.lower = early.lower;
    auto one = early;
    Eigen::Vector3d x(1, -2, 3);
    Eigen::VectorXd y = x;
    one.factor();
    one.solve(x);
    late.factor();
    late.solve(y);
    EXPECT_EQ(Eigen::VectorXd(x), y);
}

}  // namespace tridiagonal_test
}  // namespace doppel

#include "numeric/solvers.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace doppel {
namespace chain_matrix_test {

/// J M⁻¹ J′ᵀ of rods r and r′, close to each other as in two successive steps, with masses from 1/4 to 4.
struct Rods {
    Eigen::VectorXd w;
    Eigen::Matrix2Xd one, zero;

    Rods(std::mt19937& random, Eigen::Index rows) : w(rows), one(2, rows), zero(2, rows) {
        std::uniform_real_distribution<double> any(-1, 1);
        for (Eigen::Index k = 0; k < rows; ++k) {
            w[k] = std::exp2(2 * any(random));
            const double angle = 3 * any(random), length = 1.5 + any(random);
            one.col(k) << length * std::sin(angle), -length * std::cos(angle);
            zero.col(k) = one.col(k) + 0.1 * Eigen::Vector2d(any(random), any(random));
        }
    }
    double above(Eigen::Index k) const { return k == 0 ? 0 : w[k - 1]; }
    double dot(Eigen::Index i, Eigen::Index j) const { return one.col(i).dot(zero.col(j)); }
    double cross(const Eigen::Matrix2Xd& r, Eigen::Index k) const {
        return r(0, k) * r(1, k + 1) - r(1, k) * r(0, k + 1);
    }

    Eigen::MatrixXd dense() const {
        const auto n = w.size();
        Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n, n);
        for (Eigen::Index k = 0; k < n; ++k) {
            all(k, k) = (above(k) + w[k]) * dot(k, k);
            if (k + 1 == n) break;
            all(k, k + 1) = -w[k] * dot(k, k + 1);
            all(k + 1, k) = -w[k] * dot(k + 1, k);
        }
        return all;
    }
    /// The solution by a ChainMatrix of size N.
    template <int N>
    Eigen::VectorXd solved(const Eigen::VectorXd& right) const {
        using Column = typename ChainMatrix<double, N>::Column;
        const auto n = w.size();
        ChainMatrix<double, N> matrix(n);
        Column c = w, x = right;
        for (Eigen::Index k = 0; k + 1 < n; ++k) {
            matrix.upper[k] = -w[k] * dot(k, k + 1);
            matrix.lower[k] = -w[k] * dot(k + 1, k);
            c[k] = w[k] * w[k] * (cross(one, k) * cross(zero, k));
        }
        matrix.factor(
            Column(w), [&](Eigen::Index k) { return dot(k, k); }, c, 1 / (w[0] * dot(0, 0)),
            1 / ((above(n - 1) + w[n - 1]) * dot(n - 1, n - 1)));
        matrix.solve(x);
        return x;
    }
};

TEST(ChainMatrix, SolvesWhatADenseMatrixDoes) {
    std::mt19937 random(5);
    for (const Eigen::Index rows : {1, 2, 3, 4, 5, 8, 33})
        for (int i = 0; i < 100; ++i) {
            const Rods rods(random, rows);
            const Eigen::VectorXd right = Eigen::VectorXd::Random(rows);
            const Eigen::VectorXd x = rods.solved<Eigen::Dynamic>(right),
                                  expected = rods.dense().partialPivLu().solve(right);
            EXPECT_LT((x - expected).norm(), 1e-13 * (1 + expected.norm())) << rows << " rows";
            // bit-identical for a number of rows known at compile time or at run time
            if (rows == 2) {
                EXPECT_EQ(rods.solved<2>(right), x);
            }
            if (rows == 3) {
                EXPECT_EQ(rods.solved<3>(right), x);
            }
        }
}

}  // namespace chain_matrix_test
}  // namespace doppel

#include "numeric/dual.hpp"

#include "integrate/flow.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "numeric/solvers.hpp"
#include "numeric/tape.hpp"
#include "physics/angle_chain.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace doppel::dual_test {

TEST(Dual, ParametersVaryToo) {
    // the period of small oscillations grows as √l: scaling all lengths by k and the time by √k changes no angle, so
    //     l ∂θ/∂l = −½ t ω for a release from rest
    using D = Dual<double, 1>;
    auto p = unequal<D>(2);
    p.rate = {D(0), D(0)};
    for (auto& l : p.length) l.tangent[0] = l.value;
    const auto end = after<Rk4, DoublePendulum<D>>(p, DoublePendulum<D>::start(p), D(5e-4), 2000);
    for (int i = 0; i < 2; ++i)
        EXPECT_NEAR(end[i].tangent[0], -0.5 * end[2 + i].value, 2e-11);  // measured 4e-12, the error of the method
}

/// A random expression of three variables, in any scalar; the same for equal seeds.
template <class Scalar>
Scalar expression(unsigned seed, const std::array<Scalar, 3>& x) {
    using std::abs, std::cos, std::sin, std::sqrt;
    std::mt19937 random(seed);
    std::array<Scalar, 3> y = x;
    for (int i = 0; i < 8; ++i) {
        Scalar& a = y[random() % 3];
        const Scalar b = y[random() % 3], positive = Scalar(1) + b * b;
        Scalar sum = a, product = a, quotient = a;
        sum += b;
        product *= sin(b);
        quotient /= positive;
        const std::array<Scalar, 6> next{sum, b - a * b, product, quotient, cos(a) / sqrt(positive), abs(a) + b};
        a = next[random() % 6];
    }
    return y[0] + y[1] * y[2];
}

TEST(Dual, FollowsTheChainRule) {
    // relative; the round-off of sums with cancellation
    for (unsigned seed = 0; seed < 2000; ++seed) {
        using D = Dual<double, 3>;
        std::mt19937 random(seed + 77);
        std::array<double, 3> x;
        for (auto& value : x) value = std::uniform_real_distribution<double>(-2, 2)(random);
        const D f = expression<D>(seed, {D::variable(x[0], 0), D::variable(x[1], 1), D::variable(x[2], 2)});
        const std::array<Quad, 3> exact{Quad(x[0]), Quad(x[1]), Quad(x[2])};
        ASSERT_NEAR(f.value, static_cast<double>(expression<Quad>(seed, exact)), 5e-14 * (1 + std::abs(f.value)))
            << seed;  // measured 3.5e-14 of it
        for (std::size_t j = 0; j < 3; ++j) {
            auto up = exact, down = exact;
            const Quad h(1e-10);
            up[j] += h;
            down[j] -= h;
            const Quad slope = (expression<Quad>(seed, up) - expression<Quad>(seed, down)) / (2 * h);
            ASSERT_NEAR(f.tangent[static_cast<Eigen::Index>(j)], static_cast<double>(slope),
                        3e-14 * (1 + f.tangent.cwiseAbs().maxCoeff()))
                << "expression " << seed << ", variable " << j;  // measured 1.3e-14 of it
        }
    }
}

TEST(Dual, ComparesByValueAndKeepsConstants) {
    using D = Dual<double, 2>;
    EXPECT_TRUE(D::variable(1, 0) == D(1));
    EXPECT_TRUE(D::variable(1, 0) < D::variable(2, 1));
    EXPECT_TRUE(abs(D::variable(-3, 0)) == 3);
    EXPECT_EQ(abs(D::variable(-3, 0)).tangent[0], -1);
    EXPECT_EQ(sqrt(D(0)).tangent[1], 0);  // although the slope is infinite
}

TEST(Dual, SolvesLinearSystems) {
    // A(t) x(t) = b, so x′ = −A⁻¹ A′ x
    using D = Dual<double, 1>;
    Eigen::Matrix<D, 3, 3> a;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            a(i, j) = D(1.0 / (1 + i + j) + (i == j), Eigen::Matrix<double, 1, 1>(std::sin(i + 2.0 * j)));
    Eigen::Matrix<D, 3, 1> x(D(1), D(2), D(3));
    auto eliminated = a;
    solve_positive_definite(eliminated, x);
    Eigen::Matrix3d value, slope;
    Eigen::Vector3d at, along;
    for (int i = 0; i < 3; ++i) {
        at[i] = x[i].value;
        along[i] = x[i].tangent[0];
        for (int j = 0; j < 3; ++j) value(i, j) = a(i, j).value, slope(i, j) = a(i, j).tangent[0];
    }
    EXPECT_LT((value * at - Eigen::Vector3d(1, 2, 3)).norm(), 4e-15);
    EXPECT_LT((along + value.inverse() * slope * at).norm(), 2e-15);  // measured 4e-16
}

TEST(Taped, OfBytesThatAreAllZeroIsTheConstantZero) {
    // Eigen 5 sets vectors to zero by memset
    Tape<double> tape(1);
    const auto first = Taped<double>::argument(5, tape), x = Taped<double>::argument(3, tape);
    Taped<double> zero(7);
    std::memset(static_cast<void*>(&zero), 0, sizeof zero);
    EXPECT_EQ(zero.node(), Taped<double>().node());
    zero += x;
    tape.finish();
    tape.term(first.node(), 0) = 5;
    tape.term(x.node(), 0) = 3;
    tape.compute(0);
    EXPECT_EQ(zero.value, 3);
    EXPECT_EQ(tape.term(zero.node(), 0), 3);  // 8 if `zero` counted as the first argument
}

}  // namespace doppel::dual_test

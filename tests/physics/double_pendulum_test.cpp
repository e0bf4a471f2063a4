#include "physics/double_pendulum.hpp"

#include "physics/rod_chain.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel {
namespace {

/// A pendulum with everything unequal, at a state drawn from a seed.
Pendulum random_pendulum(std::mt19937& random) {
    std::uniform_real_distribution<double> size(0.3, 3), angle(-3, 3), rate(-5, 5);
    Pendulum p;
    p.mass = {size(random), size(random)};
    p.length = {size(random), size(random)};
    p.angle = {angle(random), angle(random)};
    p.rate = {rate(random), rate(random)};
    p.gravity = 9.8 * size(random);
    return p;
}

/// θ″ from the equations of motion in matrix form, M θ″ = f, solved by Eigen: another way to the closed form.
Eigen::Vector2d accelerations_by_mass_matrix(const Pendulum& p) {
    const auto [m1, m2] = p.mass;
    const auto [l1, l2] = p.length;
    const auto [t1, t2] = p.angle;
    const auto [w1, w2] = p.rate;
    const double g = p.gravity, c = std::cos(t1 - t2), s = std::sin(t1 - t2);
    Eigen::Matrix2d mass;
    mass << (m1 + m2) * l1 * l1, m2 * l1 * l2 * c, m2 * l1 * l2 * c, m2 * l2 * l2;
    const Eigen::Vector2d force(-m2 * l1 * l2 * s * w2 * w2 - (m1 + m2) * g * l1 * std::sin(t1),
                                m2 * l1 * l2 * s * w1 * w1 - m2 * g * l2 * std::sin(t2));
    return mass.inverse() * force;
}

TEST(DoublePendulum, ClosedFormSolvesTheMassMatrix) {
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
        const auto p = random_pendulum(random);
        const auto rate = DoublePendulum<double>(p).rate(DoublePendulum<double>::start(p));
        const auto expected = accelerations_by_mass_matrix(p);
        EXPECT_NEAR(rate[2], expected[0], 1e-12 * (1 + expected.norm()));  // measured 4e-15, relative
        EXPECT_NEAR(rate[3], expected[1], 1e-12 * (1 + expected.norm()));
    }
}

TEST(DoublePendulum, HangsAndStandsStillExactly) {
    Pendulum p;
    EXPECT_EQ(DoublePendulum<double>(p).rate({0, 0, 0, 0}), (State<double, 4>::Zero()));
    p.angle = {0, 0};
    EXPECT_EQ(RodChain<double>(p).rate(RodChain<double>::start(p)), (State<double, 8>::Zero()));
}

TEST(DoublePendulum, MirrorImageMovesAsTheMirrorImage) {
    std::mt19937 random(2);
    for (int i = 0; i < 50; ++i) {
        const auto p = random_pendulum(random);
        const DoublePendulum<double> model(p);
        const auto y = DoublePendulum<double>::start(p);
        EXPECT_EQ(model.rate(-y), -model.rate(y));  // to the last bit: sine and product are odd in double, too
    }
}

TEST(RodChain, FallsAsTheAnglesDo) {
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i) {
        const auto p = random_pendulum(random);
        const auto expected = accelerations_by_mass_matrix(p);
        const auto rate = RodChain<double>(p).rate(RodChain<double>::start(p));
        // r″ = l (θ″ (cos, sin) + ω² (−sin, cos)), rod upon rod
        Eigen::Vector2d acceleration = Eigen::Vector2d::Zero();
        for (std::size_t link = 0; link < link_count; ++link) {
            const double sin = std::sin(p.angle[link]), cos = std::cos(p.angle[link]), w2 = p.rate[link] * p.rate[link];
            acceleration += p.length[link] * (expected[static_cast<long>(link)] * Eigen::Vector2d(cos, sin) +
                                              w2 * Eigen::Vector2d(-sin, cos));
            const Eigen::Vector2d found = rate.segment<2>(4 + 2 * static_cast<long>(link));
            EXPECT_LT((found - acceleration).norm(), 1e-11 * (1 + acceleration.norm()));  // measured 1e-14
        }
    }
}

TEST(RodChain, BothModelsReportTheSameBobs) {
    std::mt19937 random(4);
    for (int i = 0; i < 50; ++i) {
        const auto p = random_pendulum(random);
        const auto angles = DoublePendulum<double>(p).bobs(DoublePendulum<double>::start(p));
        const auto rods = RodChain<double>(p).bobs(RodChain<double>::start(p));
        for (std::size_t link = 0; link < link_count; ++link) {
            EXPECT_NEAR(angles[link].x, rods[link].x, 1e-14);
            EXPECT_NEAR(angles[link].y, rods[link].y, 1e-14);
            EXPECT_NEAR(angles[link].vx, rods[link].vx, 1e-13);
            EXPECT_NEAR(angles[link].vy, rods[link].vy, 1e-13);
            EXPECT_NEAR(angles[link].theta, rods[link].theta, 1e-14);
            EXPECT_NEAR(angles[link].omega, rods[link].omega, 1e-13);
        }
    }
}

TEST(Pendulum, EnergyIsThatOfTheLagrangian) {
    std::mt19937 random(5);
    for (int i = 0; i < 50; ++i) {
        const auto p = random_pendulum(random);
        const auto [m1, m2] = p.mass;
        const auto [l1, l2] = p.length;
        const auto [t1, t2] = p.angle;
        const auto [w1, w2] = p.rate;
        const double kinetic = 0.5 * (m1 + m2) * l1 * l1 * w1 * w1 + 0.5 * m2 * l2 * l2 * w2 * w2 +
                               m2 * l1 * l2 * w1 * w2 * std::cos(t1 - t2);
        const double potential = -(m1 + m2) * p.gravity * l1 * std::cos(t1) - m2 * p.gravity * l2 * std::cos(t2);
        const DoublePendulum<double> model(p);
        EXPECT_NEAR(energy(model.bobs(DoublePendulum<double>::start(p)), p.gravity), kinetic + potential,
                    1e-11);  // measured 6e-14
    }
}

}  // namespace
}  // namespace doppel

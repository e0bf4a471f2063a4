#include "physics/physical_chain.hpp"

#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

namespace doppel::physical_chain_test {

using Chain = PhysicalChain<double>;

/// Rigid bodies with random unequal numbers, without friction or drive.
PhysicalPendulum<double> random_bodies(std::mt19937& random, std::size_t links) {
    std::uniform_real_distribution<double> part(0.2, 1.4);
    auto p = physical(random_pendulum(random, links));
    for (std::size_t i = 0; i < links; ++i) {
        p.center[i] *= part(random);
        p.inertia[i] = part(random) * p.chain.mass[i] * p.chain.length[i] * p.chain.length[i];
    }
    return p;
}

/// θ″ of the links.
Eigen::VectorXd accelerations(const PhysicalPendulum<double>& p) {
    const Chain chain(p);
    return rate_at_start<Chain>(p).segment(chain.layout.half, chain.layout.coordinates);
}

TEST(PhysicalChain, OfBodiesSolvesLagrangesEquations) {
    std::mt19937 random(2);
    for (int i = 0; i < 60; ++i) {
        const auto p = random_bodies(random, 1 + static_cast<std::size_t>(i % 6));
        const auto expected = by_elimination(p);
        EXPECT_LE((accelerations(p) - expected).norm(), 1e-11 * expected.norm()) << i;  // measured 3e-13
    }
}

TEST(PhysicalChain, AtRestBelowCoulombsTorqueStaysAtRestExactly) {
    auto p = physical(Pendulum<double>{{1, 1}, {1, 1}, {0.3, 0.2}, {0, 0}});
    p.friction.coulomb = {10, 5};  // at rest they need 7.7 and 1.9 N m
    EXPECT_EQ(rate_at_start<Chain>(p).norm(), 0);

    p.friction.coulomb = {10, 1.9};
    const auto rate = rate_at_start<Chain>(p);
    EXPECT_EQ(rate[2 + 1], 0);  // the first joint sticks
    EXPECT_LT(rate[3 + 1], 0);
}

TEST(PhysicalChain, AHeldJointTurnsWithTheLinkAbove) {
    // both joints at rest relative to each other, the pivot without friction: one rigid body
    auto p = physical(Pendulum<double>{{1.1, 0.6}, {0.7, 0.9}, {1.0, 1.4}, {0.5, 0.5}});
    p.friction.coulomb = {0, 1e3};
    const auto alpha = accelerations(p);
    EXPECT_EQ(alpha[0], alpha[1]);
    const double x1 = 0.7 * std::sin(1.0), y1 = -0.7 * std::cos(1.0);
    const double x2 = x1 + 0.9 * std::sin(1.4), y2 = y1 - 0.9 * std::cos(1.4);
    const double inertia = 1.1 * (x1 * x1 + y1 * y1) + 0.6 * (x2 * x2 + y2 * y2);
    EXPECT_NEAR(alpha[0], -9.8 * (1.1 * x1 + 0.6 * x2) / inertia, 1e-13);  // measured 3e-15
}

TEST(PhysicalChain, AJointIsHeldThatIsHeldWhileAnotherSlides) {
    // to hold both, the second joint would need 1.5 N m more than it has; it needs less once the first one slides
    auto p = physical(Pendulum<double>{{1, 1}, {1, 1}, {pi / 3, pi / 3}, {0, 0}});
    p.friction.coulomb = {3, 1};
    const auto alpha = accelerations(p);
    EXPECT_EQ(alpha[0], alpha[1]);
    // one body of inertia 1 + 4 under 3 g sin 60° − 3 N m
    EXPECT_NEAR(alpha[0], (3 - 3 * 9.8 * std::sin(pi / 3)) / 5, 1e-14);  // measured 0
}

TEST(PhysicalChain, AReversingJointIsHeldIfFrictionAllows) {
    auto p = physical(Pendulum<double>{{1, 1}, {1, 1}, {0.3, 0.2}, {1e-3, 0}});
    p.friction.coulomb = {10, 5};
    Chain chain(p);
    auto y = Chain::start(p);
    chain.take_modes(y);
    EXPECT_EQ(y[2 + 1], 1e-3);  // it slides, however slowly
    EXPECT_EQ(chain.margin(y), 1e-3);
    y[2 + 1] = -1e-18;
    EXPECT_LT(chain.margin(y), 0);
    chain.settle(y);
    EXPECT_EQ(y[2 + 1], 0);
    EXPECT_GT(chain.margin(y), 0);

    p.friction.coulomb = {1, 5};  // the first joint turns at once
    Chain slides(p);
    y = Chain::start(p);
    slides.take_modes(y);
    y[2 + 1] = -1e-18;
    slides.settle(y);
    EXPECT_EQ(y[2 + 1], 0);
    y[2 + 1] = -1e-18;
    EXPECT_GT(slides.margin(y), 0);
}

TEST(PhysicalChain, WorkIsTheChangeOfEnergy) {
    // dE/dt by finite differences of the energy along the motion
    std::mt19937 random(5);
    for (int i = 0; i < 20; ++i) {
        auto p = random_bodies(random, 3);
        p.friction = {{0.3, 0.1, 0.2}, {}, {0.1, 0, 0.2}, {0.02, 0.03, 0}, {0.1, 0.2, 0.3}, {0.05, 0.1, 0.02}};
        p.pivot = {0.1, 0.2, 3, 0.4};
        p.torques = {{1, 0.7, 2, 0.3}};
        Chain chain(p);
        const auto y = Chain::start(p), rate = rate_at_start<Chain>(p);
        const auto energy = [&](double h) {
            const auto after = (y + h * rate).eval();
            return configuration_of(p, chain.layout.of_links(after), chain.layout.time_of(after)).energy;
        };
        const double h = 1e-5, slope = (energy(h) - energy(-h)) / (2 * h), power = rate[chain.layout.half + 4];
        EXPECT_NEAR(power, slope, 1e-7 * (1 + std::abs(slope))) << i;  // measured 1e-8
    }
}

}  // namespace doppel::physical_chain_test

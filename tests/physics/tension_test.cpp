#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"
#include "physics/oracles.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace doppel::tension_test {

using Forces = std::vector<double>;

Forces in_angles(const Pendulum<double>& p) {
    return RodChain<double, Eigen::Dynamic>(p).tensions(released_as_particles<double, Eigen::Dynamic>(p));
}

Forces in_parts(const Assembly<double>& parts) {
    check(parts);
    return Mechanism<double>(parts).tensions(Mechanism<double>::start(parts));
}

void expect_near(const Forces& seen, const Forces& expected, double tolerance) {
    ASSERT_EQ(seen.size(), expected.size());
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_NEAR(seen[k], expected[k], tolerance) << "rod " << k + 1;
}

TEST(Tension, OfAChainInLineIsTheWeightBelow) {
    const Pendulum<double> hanging{{1, 2, 0.5, 3}, {0.5, 1, 2, 0.25}, {0, 0, 0, 0}, {0, 0, 0, 0}, 9.8};
    expect_near(in_angles(hanging), {6.5 * 9.8, 5.5 * 9.8, 3.5 * 9.8, 3 * 9.8}, 1e-13);  // measured 1.4e-14
    const Pendulum<double> upright{{1, 2}, {0.5, 1}, {pi, pi}, {0, 0}, 9.8};
    expect_near(in_angles(upright), {-3 * 9.8, -2 * 9.8}, 1e-13);  // measured 0
    expect_near(in_parts(parts_of(upright)), {-3 * 9.8, -2 * 9.8}, 1e-13);
}

double largest(const Forces& forces) {
    double maximum = 0;
    for (const double force : forces) maximum = std::max(maximum, std::abs(force));
    return maximum;
}

TEST(Tension, AndWeightGiveEachBobItsAcceleration) {
    std::mt19937 random(5);
    for (const std::size_t links : {2u, 7u})
        for (int i = 0; i < 200; ++i) {
            const auto p = random_pendulum(random, links);
            const auto forces = in_angles(p);
            const auto accelerations = accelerations_of_bobs(p);
            const auto along = [&](std::size_t k) { return P(std::sin(p.angle[k]), -std::cos(p.angle[k])); };
            for (std::size_t k = 0; k < links; ++k) {
                P sum = P(0, -p.mass[k] * p.gravity) - forces[k] * along(k);
                if (k + 1 < links) sum += forces[k + 1] * along(k + 1);
                const P expected = p.mass[k] * accelerations[k];
                EXPECT_LT((sum - expected).norm(), 7e-14 * largest(forces)) << links;  // measured 1e-14 of it
            }
        }
}

TEST(Tension, IsTheSameForEveryModel) {
    std::mt19937 random(11);
    for (const std::size_t links : {1u, 2u, 3u, 8u})
        for (int i = 0; i < 100; ++i) {
            const auto p = random_pendulum(random, links);
            const auto expected = in_angles(p);
            const double tolerance = 1e-12 * largest(expected);  // measured 1.4e-15 of it
            expect_near(in_parts(parts_of(p)), expected, tolerance);
            AngleChain<double, Eigen::Dynamic> chain(p);
            auto dydt = released_in_angles<double, Eigen::Dynamic>(p);
            chain.rate(chain.start(p), dydt);
            expect_near({chain.tension.begin(), chain.tension.end()}, expected, tolerance);
        }
}

TEST(Tension, OfAMechanismIsThatOfItsRodsAlone) {
    // a bridge of two rods, 60° to the vertical; a mass in the middle, another one below it, and a bead in a slot:
    // 2 T cos60° = m g, and the lower rod carries only its own mass
    using namespace counted;
    const double s = std::sqrt(3.0);
    Assembly<double> bridge{
        .particles = {{5, P(-s, 1)}, {2, P(0, 0)}, {3, P(0, -1)}, {1, P(4, 4)}},
        .constraints = {Anchor<double>{one, P(-s, 1)}, Rod<double>{two, one, 2}, SlotCircle<double>{four, P(4, 5), 1},
                        Rod<double>{three, two, 1}, Rod<double>{two, P(s, 1), 2}},
        .forces = {Gravity<double>{10}}};
    expect_near(in_parts(bridge), {50, 30, 50}, 1e-13);  // measured 7e-15
}

TEST(Tension, CountsForcesOtherThanWeight) {
    // a spring pulls the bob down: T = m g + k (d − l)
    using namespace counted;
    Assembly<double> parts{.particles = {{2, P(0, -1)}},
                           .constraints = {Rod<double>{one, P(0, 0), 1}},
                           .forces = {Gravity<double>{}, Spring<double>{one, P(0, -3), 8, 1.5}}};
    expect_near(in_parts(parts), {2 * 9.8 + 8 * 0.5}, 1e-13);  // measured 0
}

TEST(Tension, IsNoNumberWhereItIsNotDetermined) {
    // two aligned rods between fixed points, and a lateral force on the mass between them
    using namespace counted;
    const Assembly<double> parts{.particles = {{1, P(0, 0)}},
                                 .constraints = {Rod<double>{one, P(-1, 0), 1}, Rod<double>{one, P(1, 0), 1}},
                                 .forces = {Gravity<double>{}}};
    const auto forces = Mechanism<double>(parts).tensions(Mechanism<double>::start(parts));
    ASSERT_EQ(forces.size(), 2u);
    EXPECT_TRUE(std::isnan(forces[0]) && std::isnan(forces[1]));
}

}  // namespace doppel::tension_test

#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/mechanisms.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace doppel {
namespace tension_test {

using Forces = std::vector<double>;

Bobs<double> released(const Pendulum<double>& p) {
    return bobs_of_angles(p, released_in_angles<double, Eigen::Dynamic>(p));
}

Forces in_angles(const Pendulum<double>& p) {
    return tensions(p, released(p));
}

Forces in_parts(const Assembly<double>& parts) {
    check(parts);
    return Mechanism<double>(parts).tensions(Mechanism<double>::start(parts));
}

Pendulum<double> single(double mass, double length, double angle_deg, double rate) {
    return {{mass}, {length}, {radians(angle_deg)}, {rate}, 9.8};
}

void expect_near(const Forces& seen, const Forces& expected, double tolerance) {
    ASSERT_EQ(seen.size(), expected.size());
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_NEAR(seen[k], expected[k], tolerance) << "rod " << k + 1;
}

TEST(Tension, OfAChainAtRestIsTheWeightBelow) {
    const Pendulum<double> p{{1, 2, 0.5, 3}, {0.5, 1, 2, 0.25}, {0, 0, 0, 0}, {0, 0, 0, 0}, 9.8};
    expect_near(in_angles(p), {6.5 * 9.8, 5.5 * 9.8, 3.5 * 9.8, 3 * 9.8}, 1e-13);  // measured 1.4e-14
}

TEST(Tension, OfAnUprightChainPushes) {
    Pendulum<double> p{{1, 2}, {0.5, 1}, {pi, pi}, {0, 0}, 9.8};
    expect_near(in_angles(p), {-3 * 9.8, -2 * 9.8}, 1e-13);  // measured 0
    expect_near(in_parts(parts_of(p)), {-3 * 9.8, -2 * 9.8}, 1e-13);
}

TEST(Tension, OfASinglePendulumIsWeightAndCentripetalForce) {
    // T = m g cosθ + m l ω²; released at rest from A, m l ω² = 2 m g (cosθ − cosA)
    const double m = 1.5, l = 0.7, g = 9.8;
    const auto through_the_bottom = [&](double from_deg) {
        const double rate = std::sqrt(2 * g / l * (1 - std::cos(radians(from_deg))));
        return in_angles(single(m, l, 0, rate));
    };
    expect_near(through_the_bottom(60), {2 * m * g}, 1e-13);  // measured 1.4e-14 of all
    expect_near(through_the_bottom(90), {3 * m * g}, 1e-13);
    expect_near(through_the_bottom(180), {5 * m * g}, 1e-13);
    expect_near(in_angles(single(m, l, 90, 0)), {0}, 1e-14);
    for (const double angle : {-150.0, -40.0, 10.0, 120.0})
        expect_near(in_angles(single(m, l, angle, 3)), {m * g * std::cos(radians(angle)) + m * l * 9}, 1e-13);
}

TEST(Tension, OfADoublePendulumJustReleasedHasAClosedForm) {
    // at rest: T1 = m1 (m1 + m2) g cosθ1 / (m1 + m2 sin²D), T2 = T1 cosD m2 / (m1 + m2), D = θ2 − θ1;
    // from the system of physics/angle_chain.hpp by elimination
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i) {
        auto p = random_pendulum(random);
        p.rate = {0, 0};
        const double m1 = p.mass[0], m2 = p.mass[1], D = p.angle[1] - p.angle[0];
        const double T1 = m1 * (m1 + m2) * p.gravity * std::cos(p.angle[0]) / (m1 + m2 * std::sin(D) * std::sin(D));
        expect_near(in_angles(p), {T1, T1 * std::cos(D) * m2 / (m1 + m2)}, 1e-12);  // measured 5e-14
    }
    // released level, and with the lower rod hanging: nothing pulls, both bobs fall
    const auto level = [](double second_deg) {
        return Pendulum<double>{{1, 2}, {1, 0.5}, {radians(90), radians(second_deg)}, {0, 0}, 9.8};
    };
    expect_near(in_angles(level(90)), {0, 0}, 1e-14);
    expect_near(in_angles(level(0)), {0, 0}, 1e-14);
}

/// mass × acceleration of each bob of a chain, from its own model: q_k″ = Σ_{j≤k} l_j (θ_j″ t_j − ω_j² n_j).
template <class Model>
std::vector<P> driven(const Pendulum<double>& p) {
    Model model(p);
    const auto y = Model::start(p);
    auto dydt = y;
    model.rate(y, dydt);
    std::vector<P> forces;
    P a(0, 0);
    const auto n = static_cast<Eigen::Index>(p.links());
    for (Eigen::Index j = 0; j < n; ++j) {
        const auto i = static_cast<std::size_t>(j);
        const double sin = std::sin(y[j]), cos = std::cos(y[j]), rate = y[n + j];
        a += p.length[i] * (dydt[n + j] * P(cos, sin) - rate * rate * P(sin, -cos));
        forces.push_back(p.mass[i] * a);
    }
    return forces;
}

double greatest(const Forces& forces) {
    double most = 0;
    for (const double force : forces) most = std::max(most, std::abs(force));
    return most;
}

template <class Model>
void expect_newton(std::size_t links) {
    std::mt19937 random(5);
    double worst = 0;
    for (int i = 0; i < 200; ++i) {
        const auto p = random_pendulum(random, links);
        const auto forces = in_angles(p);
        const auto expected = driven<Model>(p);
        const auto along = [&](std::size_t k) { return P(std::sin(p.angle[k]), -std::cos(p.angle[k])); };
        for (std::size_t k = 0; k < links; ++k) {
            P sum = P(0, -p.mass[k] * p.gravity) - forces[k] * along(k);
            if (k + 1 < links) sum += forces[k + 1] * along(k + 1);
            worst = std::max(worst, (sum - expected[k]).norm() / greatest(forces));
        }
    }
    EXPECT_LT(worst, 7e-14) << links;  // measured 1e-14, 3e-15, 3e-15
}

TEST(Tension, AndWeightGiveEachBobItsAcceleration) {
    expect_newton<DoublePendulum<double>>(2);
    expect_newton<AngleChain<double, 3>>(3);
    expect_newton<AngleChain<double, Eigen::Dynamic>>(7);
}

TEST(Tension, IsTheSameOfEveryModel) {
    std::mt19937 random(11);
    for (const std::size_t links : {1u, 2u, 3u, 8u})
        for (int i = 0; i < 100; ++i) {
            const auto p = random_pendulum(random, links);
            const auto expected = in_angles(p);
            const double tolerance = 1e-12 * greatest(expected);  // measured 1.4e-15 of it
            expect_near(in_parts(parts_of(p)), expected, tolerance);
            AngleChain<double, Eigen::Dynamic> chain(p);
            auto dydt = released_in_angles<double, Eigen::Dynamic>(p);
            chain.rate(chain.start(p), dydt);
            expect_near({chain.tension.begin(), chain.tension.end()}, expected, tolerance);
        }
}

TEST(Tension, OfAMechanismIsThatOfItsRodsAlone) {
    // a bridge of two rods, 60° to the vertical, from anchors; between them a hanging mass; a bead on a slot between:
    // 2 T cos60° = m g, and the rod below bears its own mass besides
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
    // a spring that pulls down on the bob: T = m g + k (d − l)
    using namespace counted;
    Assembly<double> parts{.particles = {{2, P(0, -1)}},
                           .constraints = {Rod<double>{one, P(0, 0), 1}},
                           .forces = {Gravity<double>{}, Spring<double>{one, P(0, -3), 8, 1.5}}};
    expect_near(in_parts(parts), {2 * 9.8 + 8 * 0.5}, 1e-13);  // measured 0
}

TEST(Tension, IsNoNumberWhereItIsNotDetermined) {
    // two rods in one line between fixed places, and the mass between them pushed sideways
    using namespace counted;
    const Assembly<double> parts{.particles = {{1, P(0, 0)}},
                                 .constraints = {Rod<double>{one, P(-1, 0), 1}, Rod<double>{one, P(1, 0), 1}},
                                 .forces = {Gravity<double>{}}};
    const auto forces = Mechanism<double>(parts).tensions(Mechanism<double>::start(parts));
    ASSERT_EQ(forces.size(), 2u);
    EXPECT_TRUE(std::isnan(forces[0]) && std::isnan(forces[1]));
}

TEST(Tension, HasTheDigitsOfItsScalar) {
    const Pendulum<Quad> p{{Quad(1)}, {Quad(1)}, {Quad(0)}, {Quad(0)}, parse_quad("9.8")};
    const auto forces = tensions(p, bobs_of_angles(p, released_in_angles<Quad, Eigen::Dynamic>(p)));
    EXPECT_LT(static_cast<double>(Quad(abs(forces[0] - parse_quad("9.8")))), 8e-33);  // measured 0
}

}  // namespace tension_test
}  // namespace doppel

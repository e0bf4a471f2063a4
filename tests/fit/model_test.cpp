#include "fit/physical.hpp"
#include "fit/support.hpp"
#include "physics/angle_chain.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace model_test {

using namespace test;

/// Energy over B of the frictionless arms.
double energy(const Parameters& p, const ArmState<double>& y) {
    const auto of = [&](FitParameter parameter) { return p[index_of(parameter)]; };
    return 0.5 * of(inertia) * y[2] * y[2] + 0.5 * y[3] * y[3] + of(coupling) * std::cos(y[0] - y[1]) * y[2] * y[3] -
           of(gravity_1) * std::cos(y[0]) - of(gravity_2) * std::cos(y[1]);
}

/// dE/dt by the chain rule, of slopes that the model gives.
double power(const Parameters& p, const ArmState<double>& y, const ArmState<double>& slope) {
    double sum = 0;
    for (std::size_t q = 0; q < 4; ++q) {
        constexpr double h = 2e-5;
        auto above = y, below = y;
        above[q] += h, below[q] -= h;
        sum += (energy(p, above) - energy(p, below)) / (2 * h) * slope[q];
    }
    return sum;
}

Arms<double> arms(const Parameters& p, Drag drag) {
    auto result = arms_of({.drag = drag, .fitted = {}}, p);
    result.take_modes({0.7, -1.1, 2.3, -3.1});
    return result;
}

const ArmState<double> somewhere{0.7, -1.1, 2.3, -3.1};

TEST(FitModel, PointMassesMoveAsThePhysicsRoomHasIt) {
    const auto points = point_masses(1.3, 0.7, 0.4, 0.6);
    const auto p = ratios_of(points);
    AngleChain<double, 2> chain(points.chain);
    State<double, 4> y, expected;
    for (int q = 0; q < 4; ++q) y[q] = somewhere[static_cast<std::size_t>(q)];
    chain.rate(y, expected);
    const auto rate = arms(p, Drag::own).rate(somewhere);
    for (int q = 0; q < 4; ++q) EXPECT_NEAR(rate[static_cast<std::size_t>(q)], expected[q], 1e-12);  // measured 2e-14
}

TEST(FitModel, FrictionTakesTheEnergyThatItShould) {
    for (const auto drag : {Drag::own, Drag::carried}) {
        const auto p = lab_arms();
        const auto of = [&](FitParameter parameter) { return p[index_of(parameter)]; };
        const auto& [angle1, angle2, w1, w2] = somewhere;
        const double relative = w2 - w1;
        const double u = drag == Drag::own ? w2 : w2 + of(coupling) * std::cos(angle1 - angle2) * w1;
        const double lost = of(viscous_1) * w1 * w1 + of(viscous_2) * relative * relative +
                            of(coulomb_1) * std::abs(w1) + of(coulomb_2) * std::abs(relative) +
                            of(quadratic_1) * std::pow(std::abs(w1), 3) + of(quadratic_2) * std::pow(std::abs(u), 3);
        EXPECT_NEAR(power(p, somewhere, arms(p, drag).rate(somewhere)), -lost,
                    1e-6);  // measured 4e-8, of the differences
    }
    const auto p = lab_arms(false);
    EXPECT_NEAR(power(p, somewhere, arms(p, Drag::own).rate(somewhere)), 0, 1e-6);
}

/// A mirrored track is as good: counter-clockwise may be either way.
TEST(FitModel, IsTheSameSeenFromBehind) {
    const auto forwards = arms(lab_arms(), Drag::carried).rate(somewhere);
    auto mirrored = somewhere;
    for (auto& y : mirrored) y = -y;
    auto from_behind = arms(lab_arms(), Drag::carried);
    from_behind.take_modes(mirrored);
    const auto backwards = from_behind.rate(mirrored);
    for (std::size_t q = 0; q < 4; ++q) EXPECT_EQ(backwards[q], -forwards[q]);
}

/// Joints that turn over, stick and slip: a swing of much dry friction until it rests.
TEST(FitFlow, CoulombFrictionMovesAsThePhysicsRoomHasIt) {
    auto p = lab_arms();
    at(p, coulomb_1) = 4, at(p, coulomb_2) = 3;
    constexpr std::size_t samples = 501;
    constexpr long hz = 100;
    const auto expected = simulated_angles(fitted_pendulum(p, {}, {}).body, {1.5, -0.8, 1, -2}, hz, samples);
    Flow<double> flow(arms(p, Drag::own), {1.5, -0.8, 1, -2}, 1.0 / 512);
    double worst = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double t = static_cast<double>(i) / hz;
        ASSERT_TRUE(flow.reach(t));
        for (std::size_t arm = 0; arm < 2; ++arm)
            worst = std::max(worst, std::abs(flow.angle(arm, t) - expected[i][arm]));
    }
    EXPECT_LT(worst, 1e-8);         // measured 1.3e-9
    EXPECT_EQ(flow.rate(0, 5), 0);  // it has come to rest
    EXPECT_EQ(flow.rate(1, 5), 0);
}

TEST(FitFlow, IsOfOrderFive) {
    const auto model = arms(lab_arms(false), Drag::own);
    const auto end = [&](double step) {
        Flow<double> flow(model, somewhere, step);
        flow.reach(1);
        return flow.angle(1, 1);
    };
    const double truth = end(1.0 / 8192), coarse = end(1.0 / 256) - truth, fine = end(1.0 / 512) - truth;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 5, 0.4);  // measured 5.0
}

TEST(FitFlow, InterpolatesAsWellAsItSteps) {
    const auto model = arms(lab_arms(false), Drag::own);
    Flow<double> coarse(model, somewhere, 1.0 / 128), fine(model, somewhere, 1.0 / 4096);
    double worst = 0;
    for (int i = 1; i < 200; ++i) {
        const double t = i * 0.00137;
        coarse.reach(t), fine.reach(t);
        for (std::size_t arm = 0; arm < 2; ++arm)
            worst = std::max(worst, std::abs(coarse.angle(arm, t) - fine.angle(arm, t)));
    }
    EXPECT_LT(worst, 2e-6);  // measured 3e-7
}

TEST(FitPhysical, RatiosGoThereAndBack) {
    for (const double mass : {1.0, 0.138})
        for (const double gravity : {9.8, 1.62}) {
            const auto p = lab_arms();
            const auto pendulum = fitted_pendulum(p, {}, {gravity, mass});
            const auto back = ratios_of(pendulum.body);
            for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
            EXPECT_EQ(pendulum.body.chain.mass[1], mass);
            EXPECT_NEAR(pendulum.body.chain.length[0], gravity * 0.88 / 50, 1e-15);  // g C/D2
            EXPECT_NEAR(pendulum.body.inertia[1], mass * std::pow(pendulum.body.center[1], 2) / 3, 1e-15);
            EXPECT_GT(pendulum.body.chain.mass[0], 0);
            EXPECT_GT(pendulum.body.inertia[0], 0);
        }
}

TEST(FitPhysical, PointMassesStayPoints) {
    const auto points = point_masses(1.3, 1, 0.4, 0.6);
    const auto back = fitted_pendulum(ratios_of(points), {.point_masses = true, .fitted = {}}, {}).body;
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(back.chain.mass[k], points.chain.mass[k], 1e-12);
        EXPECT_NEAR(back.chain.length[k], points.chain.length[k], 1e-12);
        EXPECT_EQ(back.inertia[k], 0);
    }
}

/// A second arm that takes most of the first one's inertia for its own joint.
TEST(FitPhysical, MakesTheSecondArmCompactWhereItMust) {
    auto p = lab_arms(false);
    at(p, inertia) = 1.2 * 0.88 * 0.88;
    const auto pendulum = fitted_pendulum(p, {}, {});
    EXPECT_GT(pendulum.body.inertia[0], 0);
    EXPECT_GT(pendulum.body.chain.mass[0], 0);
    const auto back = ratios_of(pendulum.body);
    for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
}

}  // namespace model_test
}  // namespace doppel

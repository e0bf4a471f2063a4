#include "fit/support.hpp"
#include "physics/angle_chain.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace model_test {

using namespace test;

/// Energy over B of the frictionless arms.
double energy(const Parameters& p, const ArmState& y) {
    return 0.5 * p[inertia] * y[2] * y[2] + 0.5 * y[3] * y[3] + p[coupling] * std::cos(y[0] - y[1]) * y[2] * y[3] -
           p[gravity_1] * std::cos(y[0]) - p[gravity_2] * std::cos(y[1]);
}

/// dE/dt by the chain rule, of slopes that the model gives.
double power(const Parameters& p, const ArmState& y, const ArmState& slope) {
    double sum = 0;
    for (int q = 0; q < 4; ++q) {
        constexpr double h = 2e-5;
        auto above = y, below = y;
        above[q] += h, below[q] -= h;
        sum += (energy(p, above) - energy(p, below)) / (2 * h) * slope[q];
    }
    return sum;
}

const ArmState somewhere{0.7, -1.1, 2.3, -3.1};

/// How a state changes, by the law of joints that turn as in it.
ArmState slope_at(const ArmState& y, const Parameters& p, Drag drag) {
    auto arms = arms_of<double>({.drag = drag}, p);
    arms.modes = turning(y);
    const auto alpha = arms.accelerations(arms.sides(y[0], y[1], y[2], y[3]));
    return {y[2], y[3], alpha[0], alpha[1]};
}

TEST(FitModel, PointMassesMoveAsThePhysicsRoomHasIt) {
    const auto points = point_masses(1.3, 0.7, 0.4, 0.6);
    const auto p = ratios_of(points);
    AngleChain<double, 2> chain(points.chain);
    State<double, 4> y, expected;
    y = somewhere;
    chain.rate(y, expected);
    const auto rate = slope_at(somewhere, p, Drag::own);
    for (int q = 0; q < 4; ++q) EXPECT_NEAR(rate[q], expected[q], 1e-12);  // measured 2e-14
}

TEST(FitModel, FrictionTakesTheEnergyThatItShould) {
    for (const auto drag : {Drag::own, Drag::carried})
        for (const bool with_friction : {false, true}) {
            const auto p = lab_arms(with_friction);
            const double w1 = somewhere[2], w2 = somewhere[3], relative = w2 - w1;
            const double u = drag == Drag::own ? w2 : w2 + p[coupling] * std::cos(somewhere[0] - somewhere[1]) * w1;
            const double lost = p[viscous_1] * w1 * w1 + p[viscous_2] * relative * relative +
                                p[coulomb_1] * std::abs(w1) + p[coulomb_2] * std::abs(relative) +
                                p[quadratic_1] * std::pow(std::abs(w1), 3) + p[quadratic_2] * std::pow(std::abs(u), 3);
            EXPECT_NEAR(power(p, somewhere, slope_at(somewhere, p, drag)), -lost, 1e-6);  // measured 4e-8
        }
}

/// A mirrored track is as good: counter-clockwise may be either way.
TEST(FitModel, IsTheSameSeenFromBehind) {
    const auto forwards = slope_at(somewhere, lab_arms(), Drag::carried);
    EXPECT_EQ(slope_at(-somewhere, lab_arms(), Drag::carried), -forwards);
}

/// Joints that turn over, stick and slip: a swing of much dry friction until it rests.
TEST(FitFlow, CoulombFrictionMovesAsThePhysicsRoomHasIt) {
    auto p = lab_arms();
    p[coulomb_1] = 4, p[coulomb_2] = 3;
    constexpr std::size_t samples = 501;
    constexpr long hz = 100;
    const auto expected = simulated_angles(pendulum_of(fitted_pendulum(p, {}, {})), {1.5, -0.8, 1, -2}, hz, samples);
    Flow<> flow({}, p, {1.5, -0.8, 1, -2}, 1.0 / 512);
    double worst = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double t = static_cast<double>(i) / hz;
        ASSERT_TRUE(flow.reach(t));
        for (int arm = 0; arm < 2; ++arm)
            worst = std::max(worst, std::abs(flow.angle(arm, t)[0] - expected[i][static_cast<std::size_t>(arm)]));
    }
    EXPECT_LT(worst, 1e-8);         // measured 1.3e-9
    EXPECT_EQ(flow.rate(0, 5), 0);  // it has come to rest
    EXPECT_EQ(flow.rate(1, 5), 0);
}

TEST(FitFlow, IsOfOrderFive) {
    const auto end = [&](double step) {
        Flow<> flow({}, lab_arms(false), somewhere, step);
        flow.reach(1);
        return flow.angle(1, 1)[0];
    };
    const double truth = end(1.0 / 8192), coarse = end(1.0 / 256) - truth, fine = end(1.0 / 512) - truth;
    EXPECT_NEAR(std::log2(std::abs(coarse / fine)), 5, 0.4);  // measured 5.0
}

TEST(FitFlow, InterpolatesAsWellAsItSteps) {
    const auto p = lab_arms(false);
    Flow<> coarse({}, p, somewhere, 1.0 / 128), fine({}, p, somewhere, 1.0 / 4096);
    double worst = 0;
    for (int i = 1; i < 200; ++i) {
        const double t = i * 0.00137;
        coarse.reach(t), fine.reach(t);
        for (int arm = 0; arm < 2; ++arm)
            worst = std::max(worst, std::abs(coarse.angle(arm, t)[0] - fine.angle(arm, t)[0]));
    }
    EXPECT_LT(worst, 2e-6);  // measured 3e-7
}

void expect_there_and_back(const Parameters& p, const PhysicalPendulum<double>& pendulum) {
    for (const auto& parts : {pendulum.chain.mass, pendulum.inertia}) EXPECT_GT(parts[0], 0);
    const auto back = ratios_of(pendulum);
    for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
}

TEST(FitPhysical, RatiosGoThereAndBack) {
    for (const double mass : {1.0, 0.138})
        for (const double gravity : {9.8, 1.62}) {
            const auto pendulum = pendulum_of(fitted_pendulum(lab_arms(), {}, {gravity, mass}));
            expect_there_and_back(lab_arms(), pendulum);
            EXPECT_EQ(pendulum.chain.mass[1], mass);
            EXPECT_NEAR(pendulum.chain.length[0], gravity * 0.88 / 50, 1e-15);  // g C/D2
            EXPECT_NEAR(pendulum.inertia[1], mass * std::pow(pendulum.center[1], 2) / 3, 1e-15);
        }
    // a second arm that takes most of the first one's inertia for its own joint is more compact
    auto p = lab_arms(false);
    p[inertia] = 1.2 * 0.88 * 0.88;
    expect_there_and_back(p, pendulum_of(fitted_pendulum(p, {}, {})));
}

TEST(FitPhysical, PointMassesStayPoints) {
    const auto points = point_masses(1.3, 1, 0.4, 0.6);
    const auto back = pendulum_of(fitted_pendulum(ratios_of(points), {.point_masses = true}, {}));
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(back.chain.mass[k], points.chain.mass[k], 1e-12);
        EXPECT_NEAR(back.chain.length[k], points.chain.length[k], 1e-12);
        EXPECT_EQ(back.inertia[k], 0);
    }
}

}  // namespace model_test
}  // namespace doppel

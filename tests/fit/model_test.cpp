#include "fit/physical.hpp"
#include "fit/support.hpp"
#include "fit/variation.hpp"
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
    Arms<double> result{.p = {}, .drag = drag};
    std::copy_n(p.begin(), dynamic_count, result.p.begin());
    return result;
}

const ArmState<double> somewhere{0.7, -1.1, 2.3, -3.1};

TEST(FitModel, PointMassesMoveAsThePhysicsRoomHasIt) {
    FittedPendulum points{.gravity = 9.8};
    points.mass = {1.3, 0.7}, points.length = {0.4, 0.6}, points.center = points.length;
    const auto p = ratios_of(points);
    Pendulum<double> pendulum{.mass = {1.3, 0.7}, .length = {0.4, 0.6}, .gravity = 9.8};
    AngleChain<double, 2> chain(pendulum);
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
        const auto dry = [](double c, double w) { return c * w * w / std::hypot(w, coulomb_width); };
        const double lost = of(viscous_1) * w1 * w1 + of(viscous_2) * relative * relative + dry(of(coulomb_1), w1) +
                            dry(of(coulomb_2), relative) + of(quadratic_1) * std::pow(std::abs(w1), 3) +
                            of(quadratic_2) * std::pow(std::abs(u), 3);
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
    const auto backwards = arms(lab_arms(), Drag::carried).rate(mirrored);
    for (std::size_t q = 0; q < 4; ++q) EXPECT_EQ(backwards[q], -forwards[q]);
}

/// Derivatives written out against those that dual numbers find on their own.
TEST(FitVariation, AccelerationsChangeAsDualNumbersSay) {
    constexpr int all = 4 + static_cast<int>(dynamic_count);
    using Number = Dual<double, all>;
    for (const auto drag : {Drag::own, Drag::carried})
        for (const bool point : {false, true})
            for (const auto modes : {std::array{1, 1}, {-1, 1}, {0, 1}, {1, 0}, {0, 0}, {9, 9}}) {
                const bool is_sharp = modes[0] < 9;
                const double sign = modes[0] == 1 ? 1 : -1;
                auto p = lab_arms();
                if (point) p = completed({.point_masses = true}, p);
                Arms<Number> dual{.p = {}, .drag = drag};
                VaryingArms<all> written{.arms = arms(p, drag), .direction = {}, .point_masses = point};
                if (is_sharp) dual.dry = written.arms.dry = DryLaw::sharp, dual.modes = written.arms.modes = modes;
                written.direction.fill(-1);
                for (std::size_t k = 0; k < dynamic_count; ++k) {
                    const auto place = 4 + static_cast<Eigen::Index>(k);
                    if (point && k == index_of(gravity_1)) continue;
                    dual.p[k] = Number::variable(p[k], place);
                    written.direction[k] = place;
                }
                const auto number = [&](FitParameter parameter) -> Number& { return dual.p[index_of(parameter)]; };
                if (point) number(gravity_1) = number(inertia) * number(gravity_2) / number(coupling);
                ArmState<Number> state;
                for (std::size_t q = 0; q < 4; ++q)
                    state[q] = Number::variable(sign * somewhere[q], static_cast<Eigen::Index>(q));
                const auto expected = dual.rate(state), rate = written.rate(state);
                for (std::size_t q = 0; q < 4; ++q) {
                    EXPECT_NEAR(rate[q].value, expected[q].value, 1e-12);  // measured 3e-14
                    EXPECT_LT((rate[q].tangent - expected[q].tangent).cwiseAbs().maxCoeff(), 1e-12);
                }
            }
}

/// Joints that turn over, stick and slip: a swing of much dry friction until it rests.
TEST(FitFlow, SharpFrictionMovesAsThePhysicsRoomHasIt) {
    auto p = lab_arms();
    at(p, coulomb_1) = 4, at(p, coulomb_2) = 3;
    constexpr std::size_t samples = 501;
    constexpr long hz = 100;
    const auto expected = simulated_angles(fitted_pendulum(p, false, {}), {1.5, -0.8, 1, -2}, hz, samples);
    auto law = arms(p, Drag::own);
    law.dry = DryLaw::sharp;
    Flow<double> flow(law, {1.5, -0.8, 1, -2}, 1.0 / 512);
    double worst = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double t = static_cast<double>(i) / hz;
        ASSERT_TRUE(flow.reach(t));
        for (std::size_t arm = 0; arm < 2; ++arm)
            worst = std::max(worst, std::abs(flow.angle(arm, t) - expected[i][arm]));
    }
    EXPECT_LT(worst, 1e-8);         // measured 1.3e-9
    EXPECT_EQ(flow.state()[2], 0);  // it has come to rest
    EXPECT_EQ(flow.state()[3], 0);
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
            const auto pendulum = fitted_pendulum(p, false, {gravity, mass});
            const auto back = ratios_of(pendulum);
            for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
            EXPECT_EQ(pendulum.mass[1], mass);
            EXPECT_NEAR(pendulum.length[0], gravity * 0.88 / 50, 1e-15);  // g C/D2
            EXPECT_NEAR(pendulum.inertia[1], mass * std::pow(pendulum.center[1], 2) / 3, 1e-15);
            EXPECT_GT(pendulum.mass[0], 0);
            EXPECT_GT(pendulum.inertia[0], 0);
        }
}

TEST(FitPhysical, PointMassesStayPoints) {
    FittedPendulum points{.gravity = 9.8};
    points.mass = {1.3, 1}, points.length = {0.4, 0.6}, points.center = points.length;
    const auto back = fitted_pendulum(ratios_of(points), true, {});
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(back.mass[k], points.mass[k], 1e-12);
        EXPECT_NEAR(back.length[k], points.length[k], 1e-12);
        EXPECT_EQ(back.inertia[k], 0);
    }
}

/// A second arm that takes most of the first one's inertia for its own joint.
TEST(FitPhysical, MakesTheSecondArmCompactWhereItMust) {
    auto p = lab_arms(false);
    at(p, inertia) = 1.2 * 0.88 * 0.88;
    const auto pendulum = fitted_pendulum(p, false, {});
    EXPECT_GT(pendulum.inertia[0], 0);
    EXPECT_GT(pendulum.mass[0], 0);
    const auto back = ratios_of(pendulum);
    for (std::size_t k = 0; k < dynamic_count; ++k) EXPECT_NEAR(back[k], p[k], 1e-12 * std::abs(p[k]));
}

}  // namespace model_test
}  // namespace doppel

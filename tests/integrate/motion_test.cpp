#include "integrate/motion.hpp"

#include "integrate/methods.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/error.hpp"
#include "numeric/state.hpp"
#include "physics/double_pendulum.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace {

/// x″ = −ω² x with ω = 1: the state turns on a circle.
struct Oscillator {
    using State = doppel::State<double, 2>;
    State rate(const State& y) const { return {y[1], -y[0]}; }
    static double energy(const State& y) { return 0.5 * y.squaredNorm(); }
};

Pendulum released(double theta1_deg, double theta2_deg) {
    Pendulum p;
    p.angle = {radians(theta1_deg), radians(theta2_deg)};
    return p;
}

/// (θ1, θ2) at the end of `seconds` with steps of 1/rate.
Eigen::Vector2d end_angles(Model model, std::string_view method, const Pendulum& p, double seconds, long rate) {
    auto motion = make_motion(model, method, p, 1.0 / static_cast<double>(rate));
    motion->advance(std::lround(seconds * static_cast<double>(rate)));
    const auto bobs = motion->observe().bobs;
    return {bobs[0].theta, bobs[1].theta};
}

TEST(Euler, EnergyGrowsByTheKnownFactorEachStep) {
    // explicit Euler on the oscillator: E ← (1 + z²) E, exactly, z = ω dt
    const double z = 0.01;
    Oscillator::State y(1, 0);
    for (int i = 0; i < 1000; ++i) y = step<euler>(Oscillator(), y, z);
    EXPECT_NEAR(Oscillator::energy(y) / (0.5 * std::pow(1 + z * z, 1000)), 1, 1e-12);  // measured 1e-14
}

TEST(RungeKutta4, EnergyShrinksByTheKnownFactorEachStep) {
    // RK4 on the oscillator: E ← (1 − z⁶/72 + z⁸/576) E
    const double z = 0.5;
    Oscillator::State y(1, 0);
    for (int i = 0; i < 1000; ++i) y = step<rk4>(Oscillator(), y, z);
    const double factor = 1 - std::pow(z, 6) / 72 + std::pow(z, 8) / 576;
    EXPECT_NEAR(Oscillator::energy(y) / (0.5 * std::pow(factor, 1000)), 1, 1e-11);  // measured 7e-14
}

/// The order at which the error after 1 s shrinks when the step is halved, against a run 16 times finer with RK4.
double measured_order(Model model, std::string_view method, long rate) {
    const auto p = released(40, 70);
    const auto truth = end_angles(model, "rk4", p, 1, 16 * 1024);
    const double coarse = (end_angles(model, method, p, 1, rate) - truth).norm();
    const double fine = (end_angles(model, method, p, 1, 2 * rate) - truth).norm();
    return std::log2(coarse / fine);
}

TEST(Methods, HaveTheirOrder) {
    for (const auto model : {Model::angles, Model::constraints}) {
        EXPECT_NEAR(measured_order(model, "euler", 8192), 1, 0.02);  // measured 1.000, 1.000
        EXPECT_NEAR(measured_order(model, "rk4", 512), 4, 0.02);     // measured 4.004, 4.004
    }
}

TEST(Methods, AreThoseOfTheRegistry) {
    for (const auto& method : methods)
        EXPECT_NO_THROW(make_motion(Model::angles, method.name, Pendulum(), 1e-3)) << method.name;
    EXPECT_THROW(make_motion(Model::angles, "ruler", Pendulum(), 1e-3), Error);
}

TEST(Models, AgreeToTheOrderOfTheStep) {
    // the two formulations part by Euler's truncation error, so a quarter of the step leaves a quarter of the distance
    const auto apart = [](long rate) {
        const auto p = released(50, 0);
        return (end_angles(Model::angles, "euler", p, 3, rate) - end_angles(Model::constraints, "euler", p, 3, rate))
            .norm();
    };
    EXPECT_LT(apart(30000), 4e-3);                      // measured 5.4e-4
    EXPECT_NEAR(apart(30000) / apart(120000), 4, 0.1);  // measured 4.006
    const auto p = released(50, 0);
    EXPECT_LT((end_angles(Model::angles, "rk4", p, 3, 3000) - end_angles(Model::constraints, "rk4", p, 3, 3000)).norm(),
              1e-9);  // measured 3e-12
}

TEST(RungeKutta4, KeepsEnergyAndRods) {
    for (const auto model : {Model::angles, Model::constraints}) {
        auto motion = make_motion(model, "rk4", released(90, 90), 1.0 / 30000);
        const double start = motion->observe().energy;
        motion->advance(300'000);
        EXPECT_NEAR(motion->observe().energy, start, 1e-10);  // J; measured 1e-13, 8e-12
        EXPECT_LT(motion->observe().length_error, 1e-11);     // m; measured 0, 8e-13
    }
}

TEST(RungeKutta4, KeepsAngularMomentumWithoutGravity) {
    for (const auto model : {Model::angles, Model::constraints}) {
        auto p = released(30, 100);
        p.mass = {1.5, 0.7};
        p.rate = {2, -3};
        p.gravity = 0;
        auto motion = make_motion(model, "rk4", p, 1e-3);
        // about the pivot, kg m²/s
        const auto momentum = [&] {
            double sum = 0;
            for (const auto& bob : motion->observe().bobs) sum += bob.mass * (bob.x * bob.vy - bob.y * bob.vx);
            return sum;
        };
        const double start = momentum();
        motion->advance(10'000);
        EXPECT_NEAR(momentum(), start, 1e-10);  // measured 3e-13, 8e-13
    }
}

TEST(Euler, LetsTheRodsDriftAsMuchAsWasMeasured) {
    // P1 of the study's scheme after 10 s: rod error 3.8e-3 m at worst, energy error 1.4e-3 J
    auto motion = make_motion(Model::constraints, "euler", released(90, 90), 1.0 / 30000);
    double rod = 0;
    for (int sample = 0; sample < 1200; ++sample) {
        motion->advance(250);
        rod = std::max(rod, motion->observe().length_error);
    }
    EXPECT_NEAR(rod, 3.8e-3, 0.1e-3);  // measured 3.82e-3
}

TEST(Motion, MirrorImageStaysTheMirrorImage) {
    for (const auto model : {Model::angles, Model::constraints}) {
        auto left = make_motion(model, "rk4", released(-120, 35), 1e-3),
             right = make_motion(model, "rk4", released(120, -35), 1e-3);
        left->advance(5000);
        right->advance(5000);
        for (std::size_t link = 0; link < link_count; ++link) {
            EXPECT_EQ(left->observe().bobs[link].x, -right->observe().bobs[link].x);
            EXPECT_EQ(left->observe().bobs[link].y, right->observe().bobs[link].y);
        }
    }
}

TEST(Motion, AdvancesTheSameInOneGoOrInMany) {
    for (const auto model : {Model::angles, Model::constraints}) {
        auto once = make_motion(model, "euler", released(90, 90), 1.0 / 30000),
             often = make_motion(model, "euler", released(90, 90), 1.0 / 30000);
        once->advance(30'000);
        for (int i = 0; i < 30'000; ++i) often->advance(1);
        for (std::size_t link = 0; link < link_count; ++link) {
            EXPECT_EQ(once->observe().bobs[link].x, often->observe().bobs[link].x);
            EXPECT_EQ(once->observe().bobs[link].theta, often->observe().bobs[link].theta);
        }
    }
}

TEST(Motion, CountsWholeTurnsInBothModels) {
    // thrown fast enough to go round: ω² l > 4 g at the bottom
    auto p = released(0, 0);
    p.rate = {12, 12};
    p.angle[1] += 2 * pi;  // a turn ahead from the start
    const auto angles = end_angles(Model::angles, "rk4", p, 2, 30000),
               particles = end_angles(Model::constraints, "rk4", p, 2, 30000);
    EXPECT_GT(angles[0], 2 * pi);
    EXPECT_LT((angles - particles).norm(), 1e-8);  // measured 3e-12
}

TEST(Motion, IsPeriodicAsTheExactLargeAmplitudePendulumIs) {
    // a second bob that weighs next to nothing leaves the first a simple pendulum: T = 2π √(l/g) / agm(1, cos(A/2))
    double a = 1, b = std::cos(radians(150) / 2);
    for (int i = 0; i < 8; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    auto p = released(150, 150);
    p.mass = {1, 1e-9};
    const double period = 2 * pi * std::sqrt(p.length[0] / p.gravity) / a;
    constexpr long steps = 100'000;
    auto motion = make_motion(Model::angles, "rk4", p, period / steps);
    motion->advance(steps);
    EXPECT_NEAR(motion->observe().bobs[0].theta, p.angle[0], 1e-7);  // measured 1e-8
}

}  // namespace
}  // namespace doppel

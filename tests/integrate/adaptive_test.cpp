// The adaptive methods: their accuracy, their samples and their limits.

#include "errors.hpp"
#include "integrate/flow.hpp"
#include "integrate/taylor.hpp"
#include "physics/angle_chain.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace doppel::adaptive_test {

/// A pendulum without equal or zero numbers.
Pendulum<double> unlike() {
    return {{1.0, 0.7}, {1.0, 1.3}, {2.0, -0.5}, {0.3, 1.0}, 9.8};
}

TEST(Adaptive, SamplesWithinAStepShareItsInterpolation) {
    using Model = DoublePendulum<double>;
    const auto evaluations = [](int samples) {
        const auto p = released(90, 90);
        Model model(p);
        Dop853::Stepper<Model> stepper(model, Model::start(p), 1e-6);
        for (int i = 0; i < samples; ++i) stepper.advance(1e-3 / samples);
        EXPECT_EQ(stepper.steps(), 1);
        return stepper.evaluations();
    };
    EXPECT_EQ(evaluations(8), evaluations(1));
}

/// Order of the interpolation: the error at a quarter of the first step shrinks as step^(order + 1).
template <class Which>
double interpolation_order(double coarse_tolerance, double fine_tolerance) {
    using Model = DoublePendulum<Quad>;
    const auto measured = [](double tolerance) {
        Model model(unequal<Quad>());
        const auto start = Model::start(unequal<Quad>());
        typename Which::template Stepper<Model> stepper(model, start, Quad(tolerance));
        const Quad little = ldexp(Quad(1), -80);
        stepper.advance(little);
        const Quad step = stepper.smallest_step();
        stepper.advance(step / 4 - little);
        EXPECT_EQ(stepper.steps(), 1);
        AtFixedStep<Model, Dop853::pair> truth(model, start, step / 128);
        truth.advance(32);
        return std::pair(std::log(static_cast<double>((stepper.state() - truth.state()).norm())),
                         std::log(static_cast<double>(step)));
    };
    const auto [coarse_error, coarse_step] = measured(coarse_tolerance);
    const auto [fine_error, fine_step] = measured(fine_tolerance);
    return (coarse_error - fine_error) / (coarse_step - fine_step) - 1;
}

TEST(Interpolation, HasItsOrder) {
    EXPECT_NEAR(interpolation_order<Dopri5>(1e-10, 1e-14), 4, 0.02);
    EXPECT_NEAR(interpolation_order<Dop853>(1e-17, 1e-20), 7, 0.02);
}

template <class Which>
class Adaptively : public testing::Test {};
using AdaptiveMethods = testing::Types<Dopri5, Dop853>;
TYPED_TEST_SUITE(Adaptively, AdaptiveMethods);

template <class Which>
void expect_sampling_changes_no_step() {
    using Model = DoublePendulum<double>;
    Model model(unlike());
    typename Which::template Stepper<Model> sampled(model, Model::start(unlike()), 1e-9);
    typename Which::template Stepper<Model> at_once(model, Model::start(unlike()), 1e-9);
    for (int i = 0; i < 10240; ++i) sampled.advance(1.0 / 1024);
    at_once.advance(10);
    sampled.advance(0);
    EXPECT_EQ(sampled.state(), at_once.state());
    EXPECT_EQ(sampled.steps(), at_once.steps());
    EXPECT_EQ(sampled.smallest_step(), at_once.smallest_step());
}

TEST(Adaptive, SamplingChangesNoStep) {
    expect_sampling_changes_no_step<Dopri5>();
    expect_sampling_changes_no_step<Dop853>();
    expect_sampling_changes_no_step<Taylor>();
}

TYPED_TEST(Adaptively, TheClockNeitherDriftsNorCoarsens) {
    // 1/120 is not a double: 120 000 of them are 1000 s + 5.6e-14 s; a sum in double would have an error of 1e-9 s
    using Model = DoublePendulum<double>;
    const auto p = Pendulum<double>{{1, 1}, {1, 1}, {0.1, 0}, {0, 0}};
    Model model(p);
    typename TypeParam::template Stepper<Model> sampled(model, Model::start(p), 1e-6);
    typename TypeParam::template Stepper<Model> at_once(model, Model::start(p), 1e-6);
    for (int i = 0; i < 120000; ++i) sampled.advance(1.0 / 120);
    at_once.advance(1000);
    const double maximum = TypeParam::method.order == 5 ? 2e-14 : 1e-12;  // measured 3e-15, 1.5e-13
    EXPECT_LT((sampled.state() - at_once.state()).norm(), maximum);
}

/// The oscillator y″ = −y, which counts its evaluations.
struct Counting {
    using Scalar = double;
    using State = doppel::State<double, 2>;
    void rate(const State& y, State& dydt) {
        dydt << y[1], -y[0];
        ++requested;
    }
    long requested = 0;
};

TYPED_TEST(Adaptively, CountsItsEvaluations) {
    Counting model;
    typename TypeParam::template Stepper<Counting> stepper(model, {1, 0}, 1e-9);
    EXPECT_EQ(stepper.evaluations(), model.requested);
    for (int i = 0; i < 100; ++i) {
        stepper.advance(0.37);
        EXPECT_EQ(stepper.evaluations(), model.requested) << i;
    }
}

TYPED_TEST(Adaptively, SamplesTheEndOfAStepToo) {
    const auto after_parts = [](double first, double second) {
        Counting model;
        typename TypeParam::template Stepper<Counting> stepper(model, {1, 0}, 1e-9);
        stepper.advance(first);
        if (second > 0) stepper.advance(second);
        EXPECT_EQ(stepper.steps(), 1);
        return std::pair(stepper.smallest_step(), stepper.state());
    };
    const double step = after_parts(1e-9, 0).first;
    for (const auto& y : {after_parts(step, 0).second, after_parts(0.5 * step, 0.5 * step).second}) {
        EXPECT_NEAR(y[0], std::cos(step), 2e-16);   // measured 0
        EXPECT_NEAR(y[1], -std::sin(step), 2e-16);  // measured 2.8e-17
    }
}

TYPED_TEST(Adaptively, IsContinuousFromStepToStep) {
    using Model = DoublePendulum<double>;
    Model model(unlike());
    typename TypeParam::template Stepper<Model> stepper(model, Model::start(unlike()), 1e-8);
    auto before = stepper.state();
    double jump = 0;
    for (int i = 0; i < 100000; ++i) {
        stepper.advance(1e-5);
        typename Model::State slope = before;
        model.rate(before, slope);
        jump = std::fmax(jump, (stepper.state() - before - 1e-5 * slope).norm());
        before = stepper.state();
    }
    EXPECT_LT(jump, 1e-7);  // the curvature, ½ h² |y″|: measured 7e-8
}

/// y′ = y², y(0) = 1: 1/(1 − t)
struct BlowUp {
    using Scalar = double;
    using State = doppel::State<double, 1>;
    void rate(const State& y, State& dydt) const { dydt[0] = y[0] * y[0]; }
};

/// y′ = −1/(2 √y), y(0) = 1: √(1 − t), undefined for t > 1
struct Cliff : BlowUp {
    void rate(const State& y, State& dydt) const { dydt[0] = -1 / (2 * std::sqrt(y[0])); }
};

template <class Which, class Model>
test::Thrown failure_of(double seconds) {
    return test::thrown_by([&] {
        Model model;
        typename Model::State start;
        start << 1;
        typename Which::template Stepper<Model>(model, start, 1e-9).advance(seconds);
    });
}

TYPED_TEST(Adaptively, ReportsAVanishingStep) {
    EXPECT_EQ((failure_of<TypeParam, BlowUp>(0.9).first), ExitCode::done);
    for (const auto& [code, message] : {failure_of<TypeParam, BlowUp>(2), failure_of<TypeParam, Cliff>(2)}) {
        EXPECT_EQ(code, ExitCode::method_failed);
        EXPECT_NE(message.find("no step down to "), std::string::npos) << message;
        EXPECT_NE(message.find("tolerance = 1e-09"), std::string::npos) << message;
    }
}

/// For motions whose tangents are orthonormalised repeatedly.
TYPED_TEST(Adaptively, ResetKeepsTheStepSize) {
    using Model = DoublePendulum<double>;
    Model model(unlike());
    const auto start = Model::start(unlike());
    typename TypeParam::template Stepper<Model> stepper(model, start, 1e-8);
    stepper.advance(1.1);
    const long steps = stepper.steps();
    stepper.reset(start);
    EXPECT_EQ(stepper.state(), start);
    stepper.advance(0.01);
    EXPECT_EQ(stepper.steps(), steps + 1);  // dopri5 takes two steps after a start
    stepper.advance(1.09);
    EXPECT_LT((stepper.state() - end_of<TypeParam, Model>(unlike(), 1.1, 1e-14)).norm(), 5e-7);
}

/// A pendulum in (x, y), projected onto its circle; counts the projections.
struct OnTheCircle : RodChain<double, 1> {
    long settled = 0;
    explicit OnTheCircle(const Pendulum<double>& p) : RodChain(p) {}
    void project(State& y) {
        y.head<2>().normalize();
        y.tail<2>() -= y.tail<2>().dot(y.head<2>()) * y.head<2>();
        ++settled;
    }
};

TYPED_TEST(Adaptively, ProjectsEveryStepAndSample) {
    const Pendulum<double> p{{1}, {1}, {2}, {0}};
    OnTheCircle model(p);
    typename TypeParam::template Stepper<OnTheCircle> stepper(model, OnTheCircle::start(p), 1e-7);
    for (int i = 0; i < 1000; ++i) {
        stepper.advance(0.01);
        EXPECT_NEAR(stepper.state().template head<2>().norm(), 1, 3e-16);
    }
    EXPECT_EQ(model.settled, stepper.steps() + 1000);
    const auto angle = end_of<Dop853, AngleChain<double, 1>>(p, 10, 1e-13);
    EXPECT_NEAR(stepper.state()[0], std::sin(angle[0]), 1e-4);  // measured 2e-5, 2e-6
}

}  // namespace doppel::adaptive_test

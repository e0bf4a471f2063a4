// The adaptive methods: their accuracy, their samples and their limits.

#include "errors.hpp"
#include "integrate/dormand_prince.hpp"
#include "numeric/quad.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace doppel {
namespace adaptive_test {

Pendulum<Quad> released_at(const std::vector<int>& degrees) {
    Pendulum<Quad> p{};
    p.mass.assign(degrees.size(), Quad(1));
    p.length = p.mass;
    p.rate.assign(degrees.size(), Quad(0));
    p.angle.clear();
    for (const int angle : degrees) p.angle.push_back(pi_of<Quad>() * angle / 180);
    p.gravity = Quad(98) / 10;
    return p;
}

/// A pendulum without equal or zero numbers.
Pendulum<double> unequal() {
    return {{1.0, 0.7}, {1.0, 1.3}, {2.0, -0.5}, {0.3, 1.0}, 9.8};
}

template <class Which, class Model>
typename Model::State state_after(const Pendulum<typename Model::Scalar>& p, double seconds, double tolerance) {
    using Scalar = typename Model::Scalar;
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, Model::start(p), Scalar(tolerance));
    stepper.advance(Scalar(seconds));
    return stepper.state();
}

/// Errors of angles at the tolerances 1e-4 … 1e-13 are at most factor · tolerance; the reference is a quad run with an
/// error below 1e-15.
template <class Double, class Exact>
void keeps_to_tolerance(const std::vector<int>& degrees, double seconds, double of_dop853, double of_dopri5) {
    const auto truth = state_after<Dop853, Exact>(released_at(degrees), seconds, 1e-17);
    const auto p = released_at(degrees).cast<double>();
    for (int digits = 4; digits <= 13; ++digits) {
        const double tolerance = std::pow(10.0, -digits);
        const auto error = [&](const auto& end) {
            const auto n = static_cast<Eigen::Index>(degrees.size());
            return static_cast<double>(Quad((end.template cast<Quad>() - truth).head(n).cwiseAbs().maxCoeff()));
        };
        EXPECT_LT(error(state_after<Dop853, Double>(p, seconds, tolerance)), of_dop853 * tolerance) << digits;
        EXPECT_LT(error(state_after<Dopri5, Double>(p, seconds, tolerance)), of_dopri5 * tolerance) << digits;
    }
}

TEST(Adaptive, SamplesWithinAStepShareItsInterpolation) {
    using Model = DoublePendulum<double>;
    const auto evaluations = [](int samples) {
        const auto p = released_at({90, 90}).cast<double>();
        Model model(p);
        Dop853::Stepper<Model> stepper(model, Model::start(p), 1e-6);
        for (int i = 0; i < samples; ++i) stepper.advance(1e-3 / samples);
        EXPECT_EQ(stepper.steps(), 1);
        return stepper.evaluations();
    };
    EXPECT_EQ(evaluations(8), evaluations(1));
}

TEST(Tolerance, IsMet) {
    // the factors follow the sensitivities of the four motions to the start, 80, 21, 320 and 1040, and the length of
    // the second one; measured 170, 1500, 210, 1200, 2600, 3700, 1000, 3300
    using Two = DoublePendulum<double>;
    keeps_to_tolerance<Two, DoublePendulum<Quad>>({90, 90}, 10, 400, 3000);
    keeps_to_tolerance<Two, DoublePendulum<Quad>>({30, 0}, 60, 500, 2500);
    keeps_to_tolerance<Two, DoublePendulum<Quad>>({150, 90}, 5, 5000, 8000);
    keeps_to_tolerance<AngleChain<double, 3>, AngleChain<Quad, 3>>({120, 0, 0}, 5, 2000, 7000);
}

template <class Which>
class Adaptively : public testing::Test {};
using AdaptiveMethods = testing::Types<Dopri5, Dop853>;
TYPED_TEST_SUITE(Adaptively, AdaptiveMethods);

TYPED_TEST(Adaptively, SamplingChangesNoStep) {
    using Model = DoublePendulum<double>;
    Model model(unequal());
    typename TypeParam::template Stepper<Model> sampled(model, Model::start(unequal()), 1e-9);
    typename TypeParam::template Stepper<Model> at_once(model, Model::start(unequal()), 1e-9);
    for (int i = 0; i < 10240; ++i) sampled.advance(1.0 / 1024);
    at_once.advance(10);
    EXPECT_EQ(sampled.state(), at_once.state());
    EXPECT_EQ(sampled.steps(), at_once.steps());
    EXPECT_EQ(sampled.smallest_step(), at_once.smallest_step());
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
    Model model(unequal());
    typename TypeParam::template Stepper<Model> stepper(model, Model::start(unequal()), 1e-8);
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

TYPED_TEST(Adaptively, RefusesATolerance) {
    using Model = DoublePendulum<double>;
    Model model(unequal());
    for (const double tolerance : {1e-17, 0.0, -1.0, std::nan("")}) {
        const auto [code, said] = test::thrown_by(
            [&] { typename TypeParam::template Stepper<Model> stepper(model, Model::start(unequal()), tolerance); });
        EXPECT_EQ(code, ExitCode::bad_input) << tolerance;
        if (tolerance == 1e-17) {
            EXPECT_EQ(said, std::string(TypeParam::method.name) +
                                ": tolerance = 1e-17 is too small for 16 digits; it must be at least 9e-16");
        }
    }
    using Fine = DoublePendulum<Quad>;
    Fine fine(unequal().cast<Quad>());
    EXPECT_NO_THROW(
        (typename TypeParam::template Stepper<Fine>(fine, Fine::start(unequal().cast<Quad>()), Quad(1e-32))));
}

/// For motions whose tangents are orthonormalised repeatedly.
TYPED_TEST(Adaptively, ResetKeepsTheStepSize) {
    using Model = DoublePendulum<double>;
    Model model(unequal());
    const auto start = Model::start(unequal());
    typename TypeParam::template Stepper<Model> stepper(model, start, 1e-8);
    stepper.advance(1.1);
    const long steps = stepper.steps();
    stepper.reset(start);
    EXPECT_EQ(stepper.state(), start);
    stepper.advance(0.01);
    EXPECT_EQ(stepper.steps(), steps + 1);  // dopri5 takes two steps after a start
    stepper.advance(1.09);
    EXPECT_LT((stepper.state() - state_after<TypeParam, Model>(unequal(), 1.1, 1e-14)).norm(), 5e-7);
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
    const auto angle = state_after<Dop853, AngleChain<double, 1>>(p, 10, 1e-13);
    EXPECT_NEAR(stepper.state()[0], std::sin(angle[0]), 1e-4);  // measured 2e-5, 2e-6
}

}  // namespace adaptive_test
}  // namespace doppel

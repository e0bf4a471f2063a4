// The explicit fixed-step methods on linear problems with solutions in closed form; z = step · frequency.

#include "integrate/adams.hpp"
#include "integrate/euler.hpp"
#include "integrate/runge_kutta.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::explicit_test {

/// q″ = −q: frequency 1, so that z is the step. State (q, v).
struct Oscillator {
    using Scalar = double;
    using State = doppel::State<double, 2>;
    void rate(const State& y, State& dydt) const { dydt << y[1], -y[0]; }
};

/// y′ = −y
struct Decay {
    using Scalar = double;
    using State = doppel::State<double, 1>;
    void rate(const State& y, State& dydt) const { dydt = -y; }
};

/// |y| after `steps` steps from |y| = 1.
template <class Which, class Model>
double size_after(double step, long steps) {
    Model model;
    typename Model::State start = Model::State::Zero();
    start[0] = 1;
    typename Which::template Stepper<Model> stepper(model, start, step);
    stepper.advance(steps);
    return stepper.state().norm();
}

TEST(RungeKutta, MultipliesTheEnergyByItsStabilityFunction) {
    for (const double z : {0.01, 0.3, 1.5, 2.8}) {
        const double z2 = z * z, z4 = z2 * z2;
        EXPECT_NEAR((size_after<Euler, Oscillator>(z, 1)), std::sqrt(1 + z2), 2e-15);
        EXPECT_NEAR((size_after<Midpoint, Oscillator>(z, 1)), std::sqrt(1 + z4 / 4), 2e-15);
        EXPECT_NEAR((size_after<Rk4, Oscillator>(z, 1)), std::sqrt(1 - z2 * z4 / 72 + z4 * z4 / 576), 2e-15);
    }
}

TEST(Rk4, IsStableUpToItsLimits) {
    const double imaginary = 2 * std::sqrt(2.0);                                // of 1 − z⁶/72 + z⁸/576 = 1
    EXPECT_LT((size_after<Rk4, Oscillator>(0.999 * imaginary, 10000)), 1e-30);  // measured 1.2e-31
    EXPECT_GT((size_after<Rk4, Oscillator>(1.001 * imaginary, 10000)), 1e30);   // measured 7e30
    const double real = 2.785293563405282;                            // of 1 − z + z²/2 − z³/6 + z⁴/24 = 1
    EXPECT_LT((size_after<Rk4, Decay>(0.999 * real, 10000)), 5e-18);  // measured 5.7e-19
    EXPECT_GT((size_after<Rk4, Decay>(1.001 * real, 10000)), 2e17);   // measured 1.7e18
}

TEST(SemiImplicitEuler, KeepsItsInvariant) {
    // v² + q² − h q v, with velocities first
    for (double h : {0.01, 0.5, 1.9}) {
        Oscillator model;
        SemiImplicitEuler::Stepper<Oscillator> stepper(model, {1, 0.25}, h);
        const auto invariant = [&] {
            const double q = stepper.state()[0], v = stepper.state()[1];
            return v * v + q * q - h * q * v;
        };
        const double before = invariant();
        double worst = 0;
        for (int i = 0; i < 1000; ++i) {
            stepper.advance(1);
            worst = std::fmax(worst, std::abs(invariant() - before));
        }
        EXPECT_LT(worst, 1e-13) << "h = " << h;  // measured 1.4e-14
        EXPECT_EQ(stepper.evaluations(), 1000);
    }
}

TEST(SemiImplicitEuler, IsStableUpToTwo) {
    EXPECT_LT((size_after<SemiImplicitEuler, Oscillator>(0.999 * 2, 1000)), 100.0);  // bounded on an ellipse 1 : 45
    EXPECT_GT((size_after<SemiImplicitEuler, Oscillator>(1.001 * 2, 1000)), 1e10);
}

TEST(Adams, TakesTwoEvaluationsAStep) {
    Oscillator model;
    Adams::Stepper<Oscillator> stepper(model, {1, 0}, 0.1);
    stepper.advance(7);
    const long begun = stepper.evaluations();
    EXPECT_EQ(begun, 1 + 7 * 12);
    stepper.advance(100);
    EXPECT_EQ(stepper.evaluations() - begun, 200);
}

/// An oscillator that is projected onto the unit circle after every step, and stores the state of its last evaluation.
struct Settled : Oscillator {
    State last;
    void rate(const State& y, State& dydt) {
        last = y;
        Oscillator::rate(y, dydt);
    }
    void project(State& y) const { y.normalize(); }
};

TEST(Adams, EvaluatesSlopesAtProjectedStates) {
    Settled model;
    Adams::Stepper<Settled> stepper(model, {1, 0}, 0.1);
    for (int i = 0; i < 40; ++i) {
        stepper.advance(1);
        EXPECT_EQ(model.last, stepper.state());
        EXPECT_NEAR(stepper.state().norm(), 1, 1e-15);
    }
}

}  // namespace doppel::explicit_test

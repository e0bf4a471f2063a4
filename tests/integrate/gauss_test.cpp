#include "integrate/gauss.hpp"

#include "integrate/flow.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace gauss_test {

TEST(Gauss, HasItsOrder) {
    EXPECT_NEAR((measured_order<Gauss4, DoublePendulum<Quad>>(2, 64)), 4, 0.005);  // measured 0.00088
    EXPECT_NEAR((measured_order<Gauss6, DoublePendulum<Quad>>(2, 64)), 6, 0.01);   // measured 6.007
    EXPECT_NEAR((measured_order<Gauss6, AngleChain<Quad, 2>>(2, 64)), 6, 0.01);    // measured 6.007
}

/// How far SᵀJS is from J, where S is the Jacobian of one step in canonical variables, by differences in Quad.
template <class Which, class Model>
double symplecticity_error(const Quad& step) {
    const auto p = unequal<Quad>();
    Model model(p);
    Canonical<Model> form(model);
    using State = typename Model::State;
    const auto one = [&](const State& z) {
        State y = z;
        form.velocities(z, y);
        const State end = after<Which, Model>(p, y, step, 1);
        State z1 = end;
        form.momenta(end, z1);
        return z1;
    };
    State z = Model::start(p);
    form.momenta(State(z), z);
    return doppel::symplecticity_error(one, z);
}

TEST(Gauss, IsSymplectic) {
    const Quad step(0.1);
    EXPECT_LT((symplecticity_error<Gauss4, DoublePendulum<Quad>>(step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, DoublePendulum<Quad>>(step)), 2e-22);  // measured 2e-23
    EXPECT_LT((symplecticity_error<Gauss6, AngleChain<Quad, 2>>(step)), 2e-22);   // measured 2.7e-23
    EXPECT_GT((symplecticity_error<Rk4, DoublePendulum<Quad>>(step)), 1e-6);      // measured 3e-4
}

/// There and back again: how far from the start.
template <class Which>
double way_back(double step, long steps) {
    using Model = DoublePendulum<double>;
    const auto p = unequal<double>();
    const Model::State start = Model::start(p);
    Model::State end = after<Which, Model>(p, start, step, steps);
    end.tail(2) *= -1;
    end = after<Which, Model>(p, end, step, steps);
    end.tail(2) *= -1;
    return distance(end, start);
}

TEST(Gauss, ReturnsWhenTimeIsReversed) {
    EXPECT_LT(way_back<Gauss4>(0.02, 100), 5e-15);  // measured 9.4e-16
    EXPECT_LT(way_back<Gauss6>(0.02, 100), 1e-15);  // measured 1.9e-16
    EXPECT_GT(way_back<Rk4>(0.02, 100), 1e-6);      // measured 5e-5
}

/// Largest energy error in the first and the last tenth of a run of 30/0 (regular), J.
struct EnergyErrors {
    double early = 0, late = 0;
};
template <class Which>
EnergyErrors energy_errors(double step, long steps) {
    using Model = DoublePendulum<double>;
    Pendulum<double> p;
    p.angle = {radians(30), 0};
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, Model::start(p), step);
    const double start = energy(bobs_of_angles<double>(p, stepper.state()), p.gravity);
    EnergyErrors errors;
    for (int part = 0; part < 1000; ++part) {
        stepper.advance(steps / 1000);
        const double error = std::abs(energy(bobs_of_angles<double>(p, stepper.state()), p.gravity) - start);
        if (part < 100) errors.early = std::max(errors.early, error);
        if (part >= 900) errors.late = std::max(errors.late, error);
    }
    return errors;
}

TEST(Gauss, KeepsEnergyOverAHundredThousandPeriods) {
    // the slow mode of 30/0 takes 1.9 s: 1.9e5 s in steps of a tenth of a second
    const auto gauss = energy_errors<Gauss4>(0.1, 1'900'000);
    EXPECT_LT(gauss.late, 1.5 * gauss.early);  // measured 1.25
    EXPECT_LT(gauss.late, 2e-3);               // measured 9e-4 J
}

TEST(Gauss, KeepsEnergyWhereRungeKuttaDrifts) {
    const auto gauss = energy_errors<Gauss4>(0.05, 100'000);
    EXPECT_LT(gauss.late, 1.2 * gauss.early);  // measured 0.84
    const auto explicit_ = energy_errors<Rk4>(0.05, 100'000);
    EXPECT_GT(explicit_.late, 5 * explicit_.early);  // measured 6.6
}

TEST(Gauss, LosesNoEnergyToRounding) {
    // steps so short that truncation hides: what is left is rounding, which must walk at random
    const auto errors = energy_errors<Gauss6>(1.0 / 512, 1'000'000);
    EXPECT_LT(errors.late, 4e-14);  // measured 7e-15 J of 30; 3e-13 without compensation, 2e-13 with a loose iteration
}

TEST(Gauss, StepsDoNotDependOnHowTheyAreAskedFor) {
    using Model = DoublePendulum<double>;
    const auto p = unequal<double>();
    Model model(p), other(p);
    Gauss6::Stepper<Model> at_once(model, Model::start(p), 0.01), one_by_one(other, Model::start(p), 0.01);
    EXPECT_EQ(at_once.state(), Model::start(p));
    at_once.advance(50);
    for (int i = 0; i < 50; ++i) one_by_one.advance(1);
    EXPECT_EQ(at_once.state(), one_by_one.state());
}

TEST(Gauss, HangsStill) {
    using Model = AngleChain<double, Eigen::Dynamic>;
    const Pendulum<double> p{{1, 2, 0.5}, {1, 0.5, 2}, {0, 0, 0}, {0, 0, 0}, 9.8};
    EXPECT_EQ((after<Gauss6, Model>(p, Model::start(p), 0.1, 100)), Model::start(p));
}

TEST(Gauss, SaysWhenTheStepIsTooLong) {
    using Model = DoublePendulum<double>;
    const auto p = unequal<double>();
    try {
        after<Gauss6, Model>(p, Model::start(p), 3.0, 10);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::method_failed);
        const std::string text = error.what();
        EXPECT_EQ(text.rfind("gauss6: step ", 0), 0u) << text;
        EXPECT_NE(text.find("choose a smaller step_s than 3"), std::string::npos) << text;
    }
}

}  // namespace gauss_test
}  // namespace doppel

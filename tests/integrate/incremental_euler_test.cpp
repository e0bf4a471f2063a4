#include "integrate/euler.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <type_traits>

namespace doppel::incremental_euler_test {

constexpr double step = 1.0 / 30000;  // s

template <class Model>
using Plain = RungeKutta<Model, Euler::table>;

template <class Model, class Stepper>
typename Model::State after(const Pendulum<double>& p, double h, long steps) {
    Model model(p);
    Stepper stepper(model, Model::start(p), h);
    stepper.advance(steps);
    return stepper.state();
}

/// The difference between the ends of the incremental form and the plain one.
template <class Model>
double apart(const Pendulum<double>& p, double seconds, double h = step) {
    const long steps = std::lround(seconds / h);
    const typename Model::State y =
        after<Model, IncrementalEuler<Model>>(p, h, steps) - after<Model, Plain<Model>>(p, h, steps);
    return y.cwiseAbs().maxCoeff();
}

TEST(IncrementalEuler, IsUsedForEulerInDouble) {
    static_assert(std::is_same_v<Euler::Stepper<DoublePendulum<double>>, IncrementalEuler<DoublePendulum<double>>>);
    static_assert(std::is_same_v<Euler::Stepper<RodChain<Lanes<4>, 3>>, IncrementalEuler<RodChain<Lanes<4>, 3>>>);
    static_assert(std::is_same_v<Euler::Stepper<RodChain<long double, 3>>, Plain<RodChain<long double, 3>>>);
    static_assert(std::is_same_v<Euler::Stepper<RodChain<double, 4>>, Plain<RodChain<double, 4>>>);
}

TEST(IncrementalEuler, IsThePlainMethodUpToRounding) {
    // regular motions, where small differences remain small; the plain form has the same error against quad
    using Angles = DoublePendulum<double>;
    using Two = RodChain<double, 2>;
    using Three = RodChain<double, 3>;
    EXPECT_LT(apart<Angles>(released(30, 0), 1), 5e-14);        // measured 8e-15
    EXPECT_LT(apart<Angles>(released(30, 0), 30), 2e-12);       // measured 3e-13
    EXPECT_LT(apart<Angles>(uneven(2), 1), 5e-14);              // measured 4.7e-15
    EXPECT_LT(apart<Two>(released(30, 0), 1), 3e-13);           // measured 5.2e-14
    EXPECT_LT(apart<Two>(released(30, 0), 30), 2e-11);          // measured 7.2e-12
    EXPECT_LT(apart<Two>(uneven(2), 1), 5e-13);                 // measured 8.9e-14
    EXPECT_LT(apart<Three>(from_rest({20, 0, 0}), 1), 2e-13);   // measured 2.2e-14
    EXPECT_LT(apart<Three>(from_rest({20, 0, 0}), 30), 1e-10);  // measured 1.6e-11
    EXPECT_LT(apart<Three>(uneven(3), 1), 5e-13);               // measured 1.1e-13
}

/// One step from rest at 1e-3 rad from aligned: the change of velocities against that of the reference.
TEST(IncrementalEuler, KeepsTheDigitsOfLightMasses) {
    const auto check = [&]<int N>(const Pendulum<double>& p, std::integral_constant<int, N>) {
        const auto change = [&]<class Scalar>(const Pendulum<Scalar>& of, auto stepper) {
            using Rods = RodChain<Scalar, N>;
            Rods model(of);
            typename decltype(stepper)::type steps(model, Rods::start(of), Scalar(step));
            steps.advance(1);
            return typename Rods::State(steps.state());
        };
        const auto y = change(p, std::type_identity<IncrementalEuler<RodChain<double, N>>>());
        const auto known = change(p.cast<long double>(), std::type_identity<Plain<RodChain<long double, N>>>());
        // relative to the largest; measured 5e-14 by the rounding of the start, 3e-10 without the model's own rate
        const typename RodChain<double, N>::State error = (y - known.template cast<double>()).tail(2 * N);
        EXPECT_LT(error.cwiseAbs().maxCoeff(), 3e-13 * y.tail(2 * N).cwiseAbs().maxCoeff()) << p.mass[0] << " of " << N;
    };
    for (const double light : {1e-4, 1e-6, 1e-8}) {
        Pendulum<double> p{{light, 1}, {1, 1}, {0.5, 0.501}, {0, 0}, 9.8};
        check(p, std::integral_constant<int, 2>());
        p = {{light, 1, 1}, {1, 1, 1}, {0.5, 0.501, 0.502}, {0, 0, 0}, 9.8};
        check(p, std::integral_constant<int, 3>());
    }
}

TEST(IncrementalEuler, EvaluatesSinesDirectlyForLargeSteps) {
    // 90 rad/s at 1 ms: 0.09 rad a step, far above 2⁻¹⁰
    auto p = released(10, 50);
    p.rate = {90, -90};
    p.gravity = 0;
    EXPECT_LT(apart<DoublePendulum<double>>(p, 0.1, 1e-3), 3e-12);  // measured 5e-13
    p.rate = {90, 90};                                              // D turns slowly, θ1 does not
    p.angle = {0.3, 0.3};
    EXPECT_LT(apart<DoublePendulum<double>>(p, 0.1, 1e-3), 2e-15);  // measured 0
}

TEST(IncrementalEuler, StartsExactlyWhereItIsReleased) {
    const auto p = uneven(2);
    using Angles = DoublePendulum<double>;
    using Rods = RodChain<double, 2>;
    EXPECT_EQ((after<Angles, IncrementalEuler<Angles>>(p, step, 0)), Angles::start(p));
    EXPECT_EQ((after<Rods, IncrementalEuler<Rods>>(p, step, 0)), Rods::start(p));
}

}  // namespace doppel::incremental_euler_test

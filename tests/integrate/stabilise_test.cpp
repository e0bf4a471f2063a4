#include "integrate/stabilise.hpp"

#include "errors.hpp"
#include "integrate/euler.hpp"
#include "integrate/flow.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"
#include "physics/pendulums.hpp"
#include "physics/rod_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::stabilise_test {

using Chain = RodChain<double, 2>;

TEST(Projected, KeepsRodsThatDriftWithoutIt) {
    const auto p = released(90, 90);
    const auto drifting = errors_of<Rk4, Chain>(p, 1e-3, 10'000, 10'000);
    const auto kept = errors_of<Rk4, Projected<Chain>>(p, 1e-3, 10'000, 10'000);
    EXPECT_GT(drifting.rod, 1e-8);                  // measured 3.3e-8 m
    EXPECT_LT(kept.rod, 5e-16);                     // measured 2.2e-16 m
    EXPECT_LT(kept.slip, 7e-15);                    // measured 1.3e-15 m²/s
    EXPECT_LT(kept.energy, 3e-8);                   // measured 1.7e-8 J
    EXPECT_LT(kept.energy, 0.1 * drifting.energy);  // measured a factor 45
}

TEST(Projected, KeepsTheOrderOfTheMethod) {
    // halving the step divides the error by 16
    const auto p = released(60, -30).cast<Quad>();
    EXPECT_NEAR((measured_order<Rk4, Projected<RodChain<Quad, 2>>>(p, 400)), 4, 0.06);  // measured 4.045
}

TEST(Projected, MovesToTheConstraintsAndNoFurther) {
    // already on the constraints: no change; a heavy mass moves less than a light one
    Pendulum<double> p = released(40, -20);
    p.mass = {1, 100};
    p.rate = {1, -2};
    Projected<Chain> model(p);
    const Chain::State start = Chain::start(p);
    Chain::State y = start;
    model.project(y);
    EXPECT_LT((y - start).cwiseAbs().maxCoeff(), 1e-15);  // measured 3e-16
    y[3] += 0.01;
    Chain::State settled = y;
    model.project(settled);
    const double light = (settled - y).head(2).norm(), heavy = (settled - y).segment<2>(2).norm();
    EXPECT_LT(heavy, 0.05 * light);                                            // measured 0.012
    EXPECT_LT(length_error(p, bobs_of_particles<double>(p, settled)), 5e-16);  // measured 0
}

TEST(Projected, ReachesTheDigitsOfTheScalar) {
    const auto p = released(40, -20).cast<Quad>();
    using Model = RodChain<Quad, 2>;
    Projected<Model> model(p);
    auto y = Model::start(p);
    y[3] += Quad(0.01);
    model.project(y);
    EXPECT_LT(static_cast<double>(length_error(p, bobs_of_particles<Quad>(p, y))), 5e-34);  // measured 0
}

TEST(Projected, KeepsTheRodsOfALightFirstMass) {
    // aligned links: the condition number of J M⁻¹ Jᵀ is 4 m2 / m1, and m1 oscillates at √(2 m2 g / (l m1))
    for (const auto& [light, maximum] : {std::pair{1e-3, 2e-10}, {1e-6, 2e-13}, {1e-9, 3e-13}, {1e-12, 3e-13}}) {
        auto p = released(30, 30);
        p.mass[0] = light;
        const double step = 0.1 / std::sqrt(2 * p.gravity / light);
        const auto errors = errors_of<Rk4, Projected<Chain>>(p, step, 10'000, 10'000);
        EXPECT_LT(errors.rod, 1e-15) << light;       // measured 2.2e-16 m
        EXPECT_LT(errors.energy, maximum) << light;  // measured 3.3e-11, 2.1e-14, 3.9e-14, 5.0e-14 J
    }
}

TEST(Projected, FailsIfNoPointOnTheConstraintsIsFound) {
    const auto expect_failure = [](const Pendulum<double>& p, Chain::State y) {
        Projected<Chain> model(p);
        const auto [code, said] = test::thrown_by([&] { model.project(y); });
        EXPECT_EQ(code, ExitCode::method_failed);
        EXPECT_EQ(said.rfind("projection: the constraints still have an error of ", 0), 0u) << said;
    };
    // a rod of zero length has no direction: J M⁻¹ Jᵀ is 0
    expect_failure(released(0, 0), Chain::State::Zero(8));
    // aligned links a millimetre too far apart: the light mass between them would move far to one side
    auto p = released(30, 30);
    p.mass[0] = 1e-9;
    auto y = Chain::start(p);
    y[0] += 1e-3;
    y[3] -= 1e-3;
    expect_failure(p, y);
}

/// The growth of C, for a hanging rod stretched by 1e-9 m, after `steps` steps of Euler or Runge–Kutta with α dt = z.
template <class Which>
double growth(double z, long steps) {
    const double step = 1e-3;
    const Pendulum<Quad> p{{Quad(1)}, {Quad(1)}, {Quad(0)}, {Quad(0)}, Quad(9.8)};
    using Model = Baumgarte<RodChain<Quad, 1>>;
    Model model(p, Quad(z) / Quad(step));
    auto start = Model::start(p);
    start[1] -= Quad(1e-9);
    typename Which::template Stepper<Model> stepper(model, start, Quad(step));
    stepper.advance(steps);
    const Quad error = length_error(p, bobs_of_particles<Quad>(p, stepper.state()));
    return static_cast<double>(Quad(error / Quad(1e-9)));
}

TEST(Baumgarte, IsStableBelowTheLimitOfTheMethod) {
    // C″ = −2α C′ − α² C has the double eigenvalue −α: |R(−α dt)| = 1 at 2 (Euler) and 2.785293563 (Runge–Kutta 4)
    EXPECT_LT(growth<Euler>(2 * 0.999, 8'000), 1e-2);          // measured 2e-3
    EXPECT_GT(growth<Euler>(2 * 1.001, 2'000), 3e4);           // measured 2e5
    EXPECT_LT(growth<Rk4>(2.785293563 * 0.999, 6'000), 1e-6);  // measured 2e-7
    EXPECT_GT(growth<Rk4>(2.785293563 * 1.001, 800), 1e4);     // measured 6e4
}

TEST(Baumgarte, CorrectsErrorsByItsEquation) {
    // C″ = −2α C′ − α² C at a state off the constraints: J a + J̇ v, by the model's own functions
    Pendulum<double> p = released(40, -20);
    p.mass = {1.25, 0.5};
    p.rate = {1, -2};
    const double alpha = 7;
    Baumgarte<Chain> model(p, alpha);
    Chain::State y = Chain::start(p), dydt = y;
    y[1] += 0.02;
    y[6] -= 0.3;
    model.rate(y, dydt);
    const Chain::Half q = y.head(4), v = y.tail(4), a = dydt.tail(4);
    Chain::Multipliers c, slip, second, bend;
    model.residual(q, c);
    model.constraint_velocity(q, v, slip);
    model.constraint_velocity(q, a, second);
    model.jdot_v(q, v, bend);
    const Chain::Multipliers error = second + bend + 2 * alpha * slip + alpha * alpha * c;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 5e-15);  // measured 8e-16
    EXPECT_GT(c.cwiseAbs().maxCoeff(), 1e-3);
}

}  // namespace doppel::stabilise_test

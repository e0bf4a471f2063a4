// Every method on chains of rigid bodies with friction and drive.

#include "errors.hpp"
#include "integrate/adams.hpp"
#include "integrate/euler.hpp"
#include "integrate/flow.hpp"
#include "integrate/gauss.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/support.hpp"
#include "physics/pendulums.hpp"
#include "physics/physical_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::physical_methods_test {

using InAngles = PhysicalChain<Quad>;

/// log2 of the ratio of the errors for a step and half of it; the state includes its time and work.
template <class Which>
void expect_order(long steps, double within) {
    for (const auto& p : {bodies<Quad>(3), driven_bodies<Quad>(2)}) {
        EXPECT_NEAR((measured_order<Which, InAngles>(p, steps)), Which::method.order, within)
            << Which::method.name << (p.is_driven() ? ", driven" : "");
    }
}

TEST(PhysicalOrder, OfEveryMethodIsAsStated) {
    expect_order<Euler>(1024, 0.005);              // measured 0.0025
    expect_order<SemiImplicitEuler>(1024, 0.005);  // measured 0.0015
    expect_order<Midpoint>(512, 0.01);             // measured 0.0017
    expect_order<Rk4>(256, 0.02);                  // measured 0.006
    expect_order<Fixed<Dopri5>>(512, 0.1);         // measured 0.05
    expect_order<Fixed<Dop853>>(256, 0.05);        // measured 0.008
    expect_order<Adams>(2048, 0.15);               // measured 0.06
    expect_order<Gauss4>(64, 0.02);                // measured 0.005
    expect_order<Gauss6>(64, 0.05);                // measured 0.019
}

/// A motion of rigid bodies, sampled after `seconds`.
MotionSpec spec_of(const PhysicalPendulum<Quad>& p, std::string_view method, Rational seconds, long steps = 1) {
    MotionSpec spec;
    spec.chain = p.chain;
    spec.physical = p;
    spec.method = method;
    spec.precision = Precision::in_quad;
    spec.sample_interval = seconds;
    spec.steps_per_sample = steps;
    spec.tolerance = parse_quad("1e-30");
    return spec;
}

double apart(const Observation& a, const Observation& b) {
    Quad worst(0);
    for (std::size_t k = 0; k < a.bobs.size(); ++k) {
        const auto &one = a.exact[k], &other = b.exact[k];
        for (const Quad& difference :
             {Quad(one.x - other.x), Quad(one.y - other.y), Quad(one.vx - other.vx), Quad(one.vy - other.vy),
              Quad(one.theta - other.theta), Quad(one.omega - other.omega)})
            if (!(abs(difference) <= worst)) worst = abs(difference);
    }
    return static_cast<double>(worst);
}

TEST(PhysicalModels, AgreeInQuad) {
    const auto p = driven_bodies<Quad>(3);
    const auto truth = Course(spec_of(p, "taylor", {1, 4})).advance(1);
    auto spec = spec_of(p, "dop853", {1, 4});
    spec.tolerance = parse_quad("1e-32");  // shows errors of its coefficients from the thirtieth digit on
    EXPECT_LT(apart(truth, Course(spec).advance(1)), 1e-30);  // measured 2.8e-31
}

TEST(PhysicalModels, StartFromRestAgainstQuadraticDrag) {
    // where the speed √v² has a series of zero radius
    auto p = driven_bodies<Quad>(2);
    p.pivot = {};
    p.chain.rate = {Quad(0), Quad(0)};
    auto spec = spec_of(p, "dop853", {1, 2});
    spec.tolerance = parse_quad("1e-27");
    const auto truth = Course(spec).advance(1);
    spec.method = "taylor";
    EXPECT_LT(apart(truth, Course(spec).advance(1)), 5e-25);  // measured 8e-26, the error of dop853
}

TEST(PhysicalModels, KeepEnergyLessWork) {
    const auto p = driven_bodies<Quad>(3);
    const auto off = [&](const MotionSpec& spec) {
        const auto seen = Course(spec).advance(1);
        EXPECT_GT(std::abs(seen.work), 1);
        return std::abs(seen.energy_change);
    };
    EXPECT_LT(off(spec_of(p, "taylor", {2, 1})), 5e-15);        // measured 0
    EXPECT_LT(off(spec_of(p, "gauss6", {2, 1}, 1000)), 1e-10);  // measured 9.5e-12
    EXPECT_LT(off(spec_of(p, "rk4", {2, 1}, 2000)), 2e-7);
}

TEST(PhysicalModels, AreSteppedByRk4AsInQuad) {
    // two and three bodies in double have code of their own
    auto sticking = bodies<Quad>(2);
    sticking.friction.coulomb = {Quad(0.5), Quad(0.25)};
    for (const auto& p : {bodies<Quad>(2), bodies<Quad>(3), driven_bodies<Quad>(2), driven_bodies<Quad>(3), sticking}) {
        auto spec = spec_of(p, "rk4", {1, 1}, 2000);
        const auto truth = Course(spec).advance(1);
        spec.precision = Precision::in_double;
        const auto seen = Course(spec).advance(1);
        for (std::size_t k = 0; k < seen.bobs.size(); ++k) {
            EXPECT_NEAR(seen.bobs[k].theta, truth.bobs[k].theta, 1e-12);
            EXPECT_NEAR(seen.bobs[k].omega, truth.bobs[k].omega, 1e-11);
        }
        EXPECT_NEAR(seen.work, truth.work, 1e-11);
        EXPECT_NEAR(seen.energy_change, truth.energy_change, 1e-11);
    }
}

TEST(PhysicalModels, AreSteppedSymplecticallyByGauss) {
    const Quad step(0.1);
    EXPECT_LT((symplecticity_error<Gauss4, InAngles>(bodies<Quad>(2), step)), 2e-22);  // measured 8e-24
    EXPECT_LT((symplecticity_error<Gauss6, InAngles>(bodies<Quad>(2), step)), 2e-22);  // measured 2.0e-23
    EXPECT_GT((symplecticity_error<Rk4, InAngles>(bodies<Quad>(2), step)), 1e-5);      // measured 1.5e-4
    // friction makes the flow itself non-symplectic
    auto damped = bodies<Quad>(2);
    damped.friction.viscous = {Quad(0.125), Quad(0.25)};
    EXPECT_GT((symplecticity_error<Gauss6, InAngles>(damped, step)), 1e-2);  // measured 0.06
}

TEST(PhysicalModels, MoveInAnglesAlone) {
    const auto refusal = [](const MotionSpec& spec) { return test::thrown_by([&] { make_motion(spec); }); };
    auto spec = spec_of(bodies<Quad>(2), "rk4", {1, 1}, 100);
    spec.model = Model::constraints;
    EXPECT_EQ(refusal(spec),
              test::Thrown(ExitCode::bad_input,
                           "links with mass, friction or a drive need model = \"angles\"; it is \"constraints\""));
    spec.model = Model::angles;
    EXPECT_EQ(refusal(spec).first, ExitCode::done);
    spec.wants_tension = true;
    EXPECT_EQ(refusal(spec).second.find("rod tensions are defined for point masses"), 0u);
    spec.wants_tension = false;
    spec.physical->friction.coulomb = {Quad(0.5), Quad(0.5)};
    EXPECT_EQ(refusal(spec).first, ExitCode::done);
    spec.method = "gauss4";
    EXPECT_EQ(refusal(spec), test::Thrown(ExitCode::bad_input,
                                          "Gauss collocation does not support Coulomb friction; "
                                          "choose another method"));
}

}  // namespace doppel::physical_methods_test

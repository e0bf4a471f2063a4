#include "integrate/taylor.hpp"

#include "errors.hpp"
#include "integrate/pendulums.hpp"
#include "integrate/runge_kutta.hpp"
#include "integrate/support.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

namespace doppel {
namespace taylor_test {

template <class Scalar, int N>
using Stepper = TaylorStepper<AngleChain<Scalar, N>>;

/// The end of a motion.
template <class Model, class Scalar = typename Model::Scalar>
typename Model::State end_of(const Pendulum<Scalar>& p, const Scalar& seconds, const Scalar& tolerance, int order = 0) {
    Model model(p);
    TaylorStepper<Model> stepper(model, Model::start(p), tolerance, order);
    stepper.advance(seconds);
    return stepper.state();
}

/// The largest difference of the angles.
template <class One, class Other>
double angle_error(const One& one, const Other& other) {
    double worst = 0;
    for (Eigen::Index i = 0; i < one.size() / 2; ++i)
        worst = greater(worst, std::abs(static_cast<double>(Quad(one[i]) - Quad(other[i]))));
    return worst;
}

/// A problem, the sensitivity of its end to its start, and its end to about 27 digits.
template <int N>
struct Problem {
    Pendulum<double> pendulum;
    double seconds, sensitivity;

    const State<Quad, 2 * N>& end() const {
        static std::map<std::vector<double>, State<Quad, 2 * N>> known;
        auto [found, is_new] = known.try_emplace(pendulum.angle);
        if (is_new) found->second = end_of<AngleChain<Quad, N>>(pendulum.cast<Quad>(), Quad(seconds), Quad(1e-30));
        return found->second;
    }
    double error(double tolerance, int order = 0) const {
        return angle_error(end_of<AngleChain<double, N>>(pendulum, seconds, tolerance, order), end());
    }
};

const Problem<2> p1{from_rest({90, 90}), 10, 80}, p2{from_rest({30, 0}), 60, 21}, p3{from_rest({150, 90}), 5, 320};
const Problem<3> p4{from_rest({120, 0, 0}), 5, 1040};

/// Calls test(name, problem) for all problems.
template <class Test>
void for_each_problem(Test&& test) {
    test("P1", p1);
    test("P2", p2);
    test("P3", p3);
    test("P4", p4);
}

TEST(Taylor, ErrorIsToleranceTimesSensitivity) {
    for_each_problem([](const char* name, const auto& problem) {
        for (double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
            const double error = problem.error(tolerance);
            EXPECT_LT(error, 3 * problem.sensitivity * tolerance) << name << " at " << tolerance;  // measured ≤ 0.9
        }
        EXPECT_LT(problem.error(1e-15), 2e-15 * problem.sensitivity) << name;  // measured 6e-14, 3e-15, 7e-15, 1e-13
    });
}

TEST(Taylor, HandlesVanishingCoefficientsAtEveryOrder) {
    // from rest at 90/90, three of four coefficients are zero, whatever the order
    for (int order : {8, 9, 10, 11, 12, 13, 14, 15, 16, 20, 24})
        for (double tolerance : {1e-6, 1e-9})
            EXPECT_LT(p1.error(tolerance, order), 80 * tolerance) << order;  // measured ≤ 42 tolerance
}

TEST(Taylor, ReturnsAfterTheExactPeriod) {
    // Gauss 1799: T = 2π √(l/g) / agm(1, cos(A/2)). After a quarter of it the pendulum is at the bottom.
    using Model = AngleChain<Quad, Eigen::Dynamic>;
    struct Case {
        double amplitude, bottom, back;  // °; allowed errors of the angle there, rad
    };
    // measured 2.5e-32, 7.5e-31, 5.8e-31, 1.3e-30 and 1.2e-32, 7.2e-31, 1.2e-29, 2.4e-27
    for (const auto& [amplitude, at_bottom, at_end] :
         {Case{5.0, 2e-31, 1e-31}, Case{90.0, 5e-30, 5e-30}, Case{170.0, 5e-30, 1e-28}, Case{179.9, 7e-30, 2e-26}}) {
        const auto p = from_rest({amplitude}).cast<Quad>();
        Quad a(1), b = cos(p.angle[0] / Quad(2));
        for (int i = 0; i < 12; ++i) {
            const Quad mean = (a + b) / Quad(2);
            b = sqrt(a * b);
            a = mean;
        }
        const Quad period = Quad(2) * pi_of<Quad>() * sqrt(p.length[0] / p.gravity) / a;
        const Quad bottom = end_of<Model>(p, Quad(period / Quad(4)), Quad(1e-28))[0];
        EXPECT_LT(std::abs(static_cast<double>(bottom)), at_bottom) << amplitude;
        const auto back = end_of<Model>(p, period, Quad(1e-28));
        EXPECT_LT(std::abs(static_cast<double>(Quad(back[0] - p.angle[0]))), at_end) << amplitude;
    }
}

TEST(Taylor, HoldsInsideEveryStep) {
    // about twenty samples per step, against quad
    const auto p = p1.pendulum;
    AngleChain<double, 2> model(p);
    AngleChain<Quad, 2> exact_model(p.cast<Quad>());
    TaylorStepper stepper(model, AngleChain<double, 2>::start(p), 1e-13);
    TaylorStepper exact(exact_model, AngleChain<Quad, 2>::start(p.cast<Quad>()), Quad(1e-25));
    for (int i = 0; i < 600; ++i) {
        stepper.advance(0x1p-8);
        exact.advance(Quad(0x1p-8));
        for (int k = 0; k < 4; ++k)
            ASSERT_NEAR(stepper.state()[k], static_cast<double>(exact.state()[k]), 1e-12);  // measured 2e-13
    }
}

TEST(Taylor, StepsDoNotDependOnSampling) {
    const auto p = p1.pendulum;
    AngleChain<double, 2> model(p), other_model(p);
    TaylorStepper once(model, AngleChain<double, 2>::start(p), 1e-12);
    TaylorStepper often(other_model, AngleChain<double, 2>::start(p), 1e-12);
    once.advance(10);
    for (int i = 0; i < 100000; ++i) often.advance(1e-4);
    EXPECT_EQ(once.steps(), often.steps());
    EXPECT_EQ(once.smallest_step(), often.smallest_step());
    EXPECT_EQ(once.evaluations(), once.steps() * once.order());
    for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(once.state()[k], often.state()[k], 1e-13);  // measured 2e-14: 1e-4 is not a double
    often.advance(0);
    EXPECT_EQ(once.steps(), often.steps());
}

TEST(Taylor, LongChainsFollowRungeKutta) {
    for (const auto& [links, steps, maximum] : {std::tuple{8, 4000L, 2e-14}, {64, 3000L, 3e-13}}) {
        auto p = uneven(static_cast<std::size_t>(links));
        for (auto& l : p.length) l /= links;
        for (auto& rate : p.rate) rate = 0;
        using Model = AngleChain<double, Eigen::Dynamic>;
        Model model(p);
        const double step = 5e-6;
        Rk4::Stepper<Model> rk4(model, Model::start(p), step);
        rk4.advance(steps);
        const auto end = end_of<Model>(p, step * static_cast<double>(steps), 1e-13);
        const auto& expected = rk4.state();
        ASSERT_GT((expected - Model::start(p)).head(links).cwiseAbs().maxCoeff(), 0.01);
        EXPECT_LT(angle_error(expected, end), maximum) << links;  // measured 3e-15, 5e-14
    }
}

TEST(Taylor, KeepsRodsOfAProjectedModel) {
    using Model = Projected<RodChain<double, Eigen::Dynamic>>;
    const auto p = p1.pendulum;
    const auto bobs = bobs_of_particles(p, end_of<Model>(p, 10.0, 1e-12));
    const auto expected = bobs_of_angles(p, p1.end().cast<double>().eval());
    EXPECT_LT(length_error(p, bobs), 4e-16);                                           // m; measured 0
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(bobs[i].x, expected[i].x, 5e-11);  // measured 8e-12
    static_assert(!HasSeries<Baumgarte<RodChain<double, 2>>>);
}

// Errors.

template <class Action>
std::string error_of(ExitCode code, Action&& action) {
    const auto thrown = test::thrown_by(action);
    EXPECT_EQ(thrown.first, code);
    return thrown.second;
}

TEST(Taylor, RefusesWhatTheScalarCannotGive) {
    const auto p = p1.pendulum;
    EXPECT_EQ(error_of(ExitCode::bad_input, [&] { end_of<AngleChain<double, 2>>(p, 1.0, 1e-16); }),
              "taylor: tolerance = 1e-16 is too small for 16 digits; it must be at least 9e-16");
    EXPECT_EQ(error_of(ExitCode::bad_input, [&] { end_of<AngleChain<Quad, 2>>(p.cast<Quad>(), Quad(1), Quad(1e-34)); }),
              "taylor: tolerance = 1e-34 is too small for 34 digits; it must be at least 8e-34");
    EXPECT_NE(error_of(ExitCode::bad_input, [&] { end_of<AngleChain<double, 2>>(p, 1.0, std::nan("")); }), "no error");
}

TEST(Taylor, FailsIfTheMotionDiverges) {
    auto p = p1.pendulum;
    p.rate = {1e200, -1e200};
    EXPECT_EQ(error_of(ExitCode::method_failed, [&] { end_of<AngleChain<double, 2>>(p, 1.0, 1e-12); }).substr(0, 19),
              "taylor: coefficient");
    p.rate = {std::nan(""), 0};
    EXPECT_NE(error_of(ExitCode::method_failed, [&] { end_of<AngleChain<double, 2>>(p, 1.0, 1e-12); }), "no error");
    EXPECT_NE(error_of(ExitCode::method_failed, [&] { end_of<AngleChain<double, Eigen::Dynamic>>(p, 1.0, 1e-12); }),
              "no error");
    p.rate = {1e9, -3e9};
    EXPECT_EQ(error_of(ExitCode::method_failed, [&] { end_of<AngleChain<double, 2>>(p, 1e9, 1e-12); }).substr(0, 17),
              "taylor: the large");
}

TEST(Taylor, KeepsTheDigitsOfALightMass) {
    Pendulum<double> p{{1e-5, 1}, {1, 1}, {1, 1.001}, {0, 0}, 9.8};
    for (const std::size_t links : {2u, 3u}) {
        if (links == 3) p = {{1e-5, 1, 0.5}, {1, 1, 0.7}, {1, 1.001, 0.5}, {0, 0, 0}, 9.8};
        const auto end = [&](const char* tolerance, Precision precision) {
            auto spec = stepping(Model::angles, "taylor", p, 1);
            spec.sample_interval = {2, 1};
            spec.tolerance = parse_quad(tolerance);
            spec.precision = precision;
            return Course(spec).advance(1);
        };
        const auto found = end("1e-15", Precision::in_double), truth = end("1e-26", Precision::in_quad);
        for (std::size_t i = 0; i < links; ++i) EXPECT_NEAR(found.bobs[i].theta, truth.bobs[i].theta, 4e-12) << links;
    }
}

}  // namespace taylor_test
}  // namespace doppel

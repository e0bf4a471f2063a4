#include "analysis/reference.hpp"

#include "errors.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::reference_test {

const std::atomic<bool> never = false;

MotionSpec chain(std::vector<double> angle_deg) {
    MotionSpec spec;
    spec.chain = from_rest(std::move(angle_deg)).cast<Quad>();
    return spec;
}

/// The difference of two angles modulo whole turns, rad: from sines in quad, so that turns cost no digits.
double apart(const Quad& one, const Quad& other) {
    return std::abs(static_cast<double>(Quad(2 * sin(Quad((one - other) / 2)))));
}

/// The end of a motion by a method or equations other than those of the reference, in quad.
Bobs<Quad> end_by(MotionSpec spec, const char* method, const char* tolerance, const Rational& seconds) {
    spec.method = method;
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad(tolerance);
    spec.sample_interval = seconds;
    const auto motion = make_motion(spec);
    motion->advance(never);
    return motion->observe().exact;
}

TEST(ErrorMeasure, ResolvesErrorsBelowTheRoundingOfTurnsInQuad) {
    // a known error, and whole turns that one formulation counts and the other does not
    for (const int turns : {0, 1, -1, 7, 11, 13, 15, 1000})
        for (const double planted : {0.0, 3e-30, -1e-17, 2e-9}) {
            const Quad one = parse_quad("1.234567890123456789012345678901234"), turn = 2 * pi_of<Quad>();
            Observation a, b, rounded;
            a.exact = {{.mass = 1, .x = 0, .y = 0, .vx = 0, .vy = 0, .theta = one}};
            b = a;
            b.exact[0].theta = one + turns * turn + Quad(planted);
            EXPECT_NEAR(ErrorMeasure{}.distance(a, b), std::abs(planted), 1e-30 * (1 + std::abs(turns)))
                << turns << ' ' << planted;  // measured 0.1 of it
            // and if one of them is in double
            rounded.bobs = {{.mass = 1, .x = 0, .y = 0, .vx = 0, .vy = 0}};
            rounded.bobs[0].theta = static_cast<double>(b.exact[0].theta);
            const double rounding = std::abs(static_cast<double>(Quad(b.exact[0].theta - Quad(rounded.bobs[0].theta))));
            EXPECT_NEAR(ErrorMeasure{}.distance(rounded, b), rounding, 1e-30 * (1 + std::abs(turns)))
                << turns << ' ' << planted;
        }
}

TEST(ErrorMeasure, IsThatOfTheWorst) {
    const auto seen = [](std::vector<double> numbers) {
        Observation made;
        for (const double number : numbers) {
            made.bobs.push_back({1, number, -number, 0, 0});
            made.bobs.back().theta = number;
        }
        return made;
    };
    const ErrorMeasure angles, places{false, 2};
    EXPECT_NEAR(angles.distance(seen({0.1, 1}), seen({0.1, 1.3})), 0.3, 1e-15);
    EXPECT_NEAR(angles.distance(seen({0.1, 1}), seen({0.5, 1.3})), 0.4, 1e-15);
    EXPECT_NEAR(angles.distance(seen({0, 0}), seen({0, 3 * pi})), pi, 1e-14);
    EXPECT_DOUBLE_EQ(places.distance(seen({0, 1}), seen({0, 4})), 3 * std::sqrt(2.0) / 2);
    for (const auto& measure : {angles, places})
        EXPECT_TRUE(std::isnan(measure.distance(seen({0, 0}), seen({0, NAN}))));
}

TEST(Reference, ComparesEveryAngleModuloTurns) {
    // P3 ends with θ2 = 2.89 π; one link makes eleven turns
    auto turning = chain({0});
    turning.chain->rate[0] = 4000 * pi_of<Quad>() / 180;
    for (const auto& [spec, seconds] : {std::pair{chain({150, 90}), 5L}, {turning, 1L}}) {
        const auto reference = reference_end(spec, {seconds, 1}, never);
        EXPECT_GT(reference.disagreement, 0);      // 0 if the comparison missed differences
        EXPECT_LT(reference.disagreement, 1e-28);  // measured 3e-31, 6e-30
        EXPECT_GT(static_cast<double>(abs(reference.end.exact.back().theta)), pi);
    }
}

TEST(Reference, AgreesWithOtherEquationsAndAnotherMethod) {
    const auto spec = chain({150, 90});
    const auto reference = reference_end(spec, {5, 1}, never);
    // the lower rod makes a turn: with constraints its angle ends a whole turn away
    EXPECT_GT(std::abs(static_cast<double>(reference.end.exact.at(1).theta)), 2 * pi);
    auto rods = spec;
    rods.model = Model::constraints;
    const auto particles = end_by(rods, "taylor", "1e-32", {5, 1}), other = end_by(spec, "dop853", "1e-22", {5, 1});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(apart(reference.end.exact[i].theta, particles[i].theta), 2e-30) << i;  // measured 4e-32, 3.2e-31
        EXPECT_LT(apart(reference.end.exact[i].theta, other[i].theta), 3e-21) << i;      // measured 1.5e-22, 4.3e-22
    }
}

TEST(Reference, OfOneLinkAfterItsPeriod) {
    MotionSpec spec;
    spec.chain = Pendulum<Quad>{{1}, {1}, {pi_of<Quad>() / 2}, {0}, 1};
    // gravity for a period of one second
    spec.chain->gravity = pow(exact_period(*spec.chain), 2);
    const auto reference = reference_end(spec, {1, 1}, never);
    EXPECT_LT(static_cast<double>(abs(Quad(reference.end.exact[0].theta - pi_of<Quad>() / 2))),
              3e-33);                                                          // measured 4e-34
    EXPECT_LT(static_cast<double>(abs(reference.end.exact[0].omega)), 5e-32);  // measured 6e-33
}

TEST(Reference, OfARunWithStabilisedRodsIsThatOfTheTrueMotion) {
    auto rods = chain({30, 20});
    rods.model = Model::constraints;
    rods.method = "rk4";
    const auto reference = reference_end(rods, {1, 1}, never);
    rods.stabilise = Stabilise::projection;
    const auto same = reference_end(rods, {1, 1}, never);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(same.end.exact[i].theta, reference.end.exact[i].theta);
}

TEST(Reference, RefusesWhereTheTwoDisagree) {
    const auto [code, said] = test::thrown_by([] { reference_end(chain({170, 100}), {50, 1}, never); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(said.find("no reference"), std::string::npos) << said;
}

TEST(Reference, OfAMechanismByTwoTolerances) {
    // a mass in circular motion on a spring of rest length 0, without gravity: x = cos t, y = sin t
    MotionSpec spec;
    spec.model = Model::mechanism;
    spec.parts.emplace();
    spec.parts->particles.push_back({1, Place<Quad>(1, 0), Place<Quad>(0, 1)});
    spec.parts->forces.emplace_back(Spring<Quad>{0, Place<Quad>(0, 0), 1, 0, 0});
    const auto reference = reference_end(spec, {2, 1}, never);
    const Quad x = cos(Quad(2)), y = sin(Quad(2));
    const auto& end = reference.end.exact.at(0);
    for (const Quad& error : {Quad(end.x - x), Quad(end.y - y), Quad(end.vx + y), Quad(end.vy - x)})
        EXPECT_LT(static_cast<double>(abs(error)), 4e-34);  // measured 5e-35
}

double sensitivity(const std::vector<double>& angle_deg, const Rational& seconds) {
    return reference_end(chain(angle_deg), seconds, never).sensitivity;
}

TEST(Sensitivity, OfTheFourProblems) {
    // from tangent equations in dual numbers: 80.25, 20.59, 319.7, 1043.6; in another program 80, 21, 320, 1040
    EXPECT_NEAR(sensitivity({90, 90}, {10, 1}), 80.25, 0.005);
    EXPECT_NEAR(sensitivity({30, 0}, {60, 1}), 20.59, 0.005);
    EXPECT_NEAR(sensitivity({150, 90}, {5, 1}), 319.7, 0.05);
    EXPECT_NEAR(sensitivity({120, 0, 0}, {5, 1}), 1043.6, 0.05);
}

TEST(Sensitivity, OfSmallSwingsInClosedForm) {
    // one link near the bottom: θ(t) = θ(0) cos ωt; near the upright: cosh ωt
    const double rate = std::sqrt(9.8);
    EXPECT_NEAR(sensitivity({1e-7}, {2, 1}), std::abs(std::cos(2 * rate)), 1e-10);
    EXPECT_NEAR(sensitivity({180}, {6, 1}) / std::cosh(6 * rate), 1, 1e-10);  // relative to 7e7
}

TEST(Sensitivity, IsOfChainsOfPointMassesAlone) {
    auto spec = chain({90, 90});
    spec.physical = physical(*spec.chain);
    EXPECT_TRUE(std::isnan(reference_end(spec, {1, 10}, never).floor()));
}

constexpr double enough = 0.5;

MotionSpec in_double(const std::vector<double>& angle_deg) {
    auto spec = chain(angle_deg);
    spec.method = "taylor";
    spec.tolerance = parse_quad("1e-10");
    spec.sample_interval = {1, 10};
    return spec;
}

TEST(ReferenceTrajectory, OfAMotionInDoubleIsInQuadWhereThatCostsLittle) {
    const auto spec = in_double({90, 90});
    const auto wide = reference_trajectory(spec, 50, 2, enough, never);
    EXPECT_TRUE(wide.is_wider);
    ASSERT_EQ(wide.seen.size(), 51u);
    EXPECT_LT(wide.uncertainty.back(), 2e-14);  // the error of numbers rounded once
    EXPECT_GT(wide.uncertainty.back(), 1e-16);
    // compared with quad at another tolerance
    auto finer = spec;
    finer.precision = Precision::in_quad;
    finer.tolerance = parse_quad("1e-28");
    const auto motion = make_motion(finer);
    for (std::size_t sample = 1; sample <= 50; ++sample) {
        motion->advance(never);
        EXPECT_LT(wide.error_at(sample, motion->observe()), 1e-20);  // measured 3.4e-21
    }
    EXPECT_FALSE(reference_trajectory(spec, 50, 2, enough, never, 0).is_wider);
}

TEST(ReferenceTrajectory, EstimatesItsErrorInItsOwnPrecision) {
    struct Released {
        std::vector<double> degrees, mass;
    };
    for (const auto& [degrees, mass] : {Released{{90, 90}, {1, 1}},
                                        {{150, 90}, {1, 1}},
                                        {{30, 0}, {1, 1}},
                                        {{120, 0, 0}, {1, 1, 1}},
                                        {{170}, {1}},
                                        {{100, -40}, {0.001, 1}},
                                        {{60, 100, -20}, {1, 0.0001, 1}}}) {
        auto spec = in_double(degrees);
        spec.chain->mass.assign(mass.begin(), mass.end());
        const auto own = reference_trajectory(spec, 150, 3, enough, never, 0),
                   wide = reference_trajectory(spec, 150, 3, enough, never);
        EXPECT_TRUE(wide.is_wider && !own.is_wider);
        for (std::size_t sample = 10; sample < own.seen.size(); ++sample) {
            double off = 0;
            for (std::size_t i = 0; i < own.seen[sample].size(); ++i)
                off = std::max(off, std::abs(static_cast<double>(Quad(own.seen[sample][i] - wide.seen[sample][i]))));
            EXPECT_LE(off, own.uncertainty[sample]) << degrees[0] << ' ' << sample;  // measured 0.62 of it at most
        }
    }
}

TEST(ReferenceTrajectory, EndsShortlyAfterThePredictabilityLimit) {
    const auto wide = reference_trajectory(in_double({150, 90}), 1000, 2, enough, never);
    EXPECT_LT(wide.seen.size(), 600u);
    const auto history = error_history(in_double({150, 90}), wide, enough, never);
    EXPECT_LT(history.error.size(), wide.seen.size());
    EXPECT_GT(history.error.back(), enough);
    EXPECT_EQ(history.last_within(enough), static_cast<long>(history.error.size()) - 2);
    EXPECT_EQ(history.last_within(-1), -1);
    EXPECT_TRUE(std::isinf(history.at(history.error.size())));
    EXPECT_TRUE(history.failure.empty());
}

TEST(ErrorHistory, GivesTheReasonOfAFailure) {
    const auto reference = reference_trajectory(in_double({150, 90}), 20, 2, enough, never);
    auto spec = in_double({150, 90});
    spec.method = "gauss4";
    spec.steps_per_sample = 1;
    spec.sample_interval = {1, 10};
    spec.chain->rate = {Quad(60), Quad(-80)};  // too fast for steps of 0.1 s
    const auto history = error_history(spec, reference, 1e9, never);
    EXPECT_LT(history.error.size(), 3u);
    EXPECT_NE(history.failure.find("the stages still change"), std::string::npos) << history.failure;
}

TEST(Reference, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(reference_trajectory(in_double({90, 90}), 10, 2, enough, stop), Error);
    EXPECT_THROW(reference_end(chain({90, 90}), {10, 1}, stop), Error);
}

}  // namespace doppel::reference_test

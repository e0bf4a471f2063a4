#include "analysis/reference.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "integrate/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace reference_test {

const std::atomic<bool> never = false;

MotionSpec chain(std::vector<double> angle_deg) {
    MotionSpec spec;
    spec.chain = from_rest(std::move(angle_deg)).cast<Quad>();
    return spec;
}

/// How far apart two angles are, rad, up to whole turns: from sines in quad, so that no turn costs a digit.
double apart(const Quad& one, const Quad& other) {
    return std::abs(static_cast<double>(Quad(2 * sin(Quad((one - other) / 2)))));
}

/// The end of a motion by another method or equations than those of the reference, in quad.
Bobs<Quad> end_by(MotionSpec spec, const char* method, const char* tolerance, const Rational& seconds) {
    spec.method = method;
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad(tolerance);
    spec.sample_interval = seconds;
    const auto motion = make_motion(spec);
    motion->advance(never);
    return motion->observe().exact;
}

TEST(AngleError, SeesInQuadBelowTheRoundingOfWholeTurns) {
    // a planted error, and as many turns between the two as one formulation counts and the other does not
    for (const int turns : {0, 1, -1, 7, 11, 13, 15, 1000})
        for (const double planted : {0.0, 3e-30, -1e-17, 2e-9}) {
            const Quad one = parse_quad("1.234567890123456789012345678901234"), turn = 2 * pi_of<Quad>();
            const Bobs<Quad> a{{.mass = 1, .x = 0, .y = 0, .vx = 0, .vy = 0, .theta = one}};
            auto b = a;
            b[0].theta = one + turns * turn + Quad(planted);
            EXPECT_NEAR(angle_error(a, b), std::abs(planted), 1e-30 * (1 + std::abs(turns)))  // measured 0.1 of it
                << turns << ' ' << planted;
            // and where one of them is in double
            Bobs<double> rounded{{.mass = 1, .x = 0, .y = 0, .vx = 0, .vy = 0, .theta = 0}};
            rounded[0].theta = static_cast<double>(b[0].theta);
            const double rounding = std::abs(static_cast<double>(Quad(b[0].theta - Quad(rounded[0].theta))));
            EXPECT_NEAR(angle_error(rounded, b), rounding, 1e-30 * (1 + std::abs(turns))) << turns << ' ' << planted;
        }
}

TEST(AngleError, IsThatOfTheWorstAngle) {
    const auto bobs = [](double first, double second) {
        Bobs<double> all(2, {1, 0, 0, 0, 0});
        all[0].theta = first;
        all[1].theta = second;
        return all;
    };
    EXPECT_NEAR(angle_error(bobs(0.1, 1), bobs(0.1, 1.3)), 0.3, 1e-15);
    EXPECT_NEAR(angle_error(bobs(0.1, 1), bobs(0.5, 1.3)), 0.4, 1e-15);
    EXPECT_NEAR(angle_error(bobs(0, 0), bobs(0, 3 * pi)), pi, 1e-14);
    EXPECT_TRUE(std::isnan(angle_error(bobs(0, 0), bobs(0, NAN))));
}

TEST(Reference, CertifiesEveryAngleAndAfterWholeTurns) {
    // P3 ends with θ2 = 2.89 π; one link that turns eleven times
    auto turning = chain({0});
    turning.chain->rate[0] = 4000 * pi_of<Quad>() / 180;
    for (const auto& [spec, seconds] : {std::pair{chain({150, 90}), 5L}, {turning, 1L}}) {
        const auto reference = reference_end(spec, {seconds, 1}, 1e-26, never);
        EXPECT_GT(reference.disagreement, 0);      // blind, it was 0
        EXPECT_LT(reference.disagreement, 1e-28);  // measured 3e-31, 6e-30
        EXPECT_GT(static_cast<double>(abs(reference.end.back().theta)), pi);
    }
}

TEST(Reference, OfTwoEquationsThatAgree) {
    const auto spec = chain({150, 90});
    const auto reference = reference_end(spec, {5, 1}, 1e-26, never);
    EXPECT_LT(reference.disagreement, 2e-30);  // measured 4e-32 in θ1, 3e-31 in θ2
    ASSERT_EQ(reference.end.size(), 2u);
    // the lower rod turns over: as particles its angle ends a whole turn away
    EXPECT_GT(std::abs(static_cast<double>(reference.end[1].theta)), 2 * pi);
    auto rods = spec;
    rods.model = Model::constraints;
    const auto particles = end_by(rods, "taylor", "1e-32", {5, 1}), other = end_by(spec, "dop853", "1e-22", {5, 1});
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(apart(reference.end[i].theta, particles[i].theta), 2e-30) << i;  // measured 4e-32, 3.2e-31
        EXPECT_LT(apart(reference.end[i].theta, other[i].theta), 3e-21) << i;      // measured 1.5e-22, 4.3e-22
    }
}

TEST(Reference, OfOneLinkAfterItsPeriod) {
    // Gauss 1799: T = 2π √(l/g) / agm(1, cos(A/2)), here of A = 90° in quad
    Quad a = 1, b = sqrt(Quad(0.5));
    for (int i = 0; i < 8; ++i) {
        const Quad mean = (a + b) / 2;
        b = sqrt(Quad(a * b));
        a = mean;
    }
    MotionSpec spec;
    spec.chain = Pendulum<Quad>{{1}, {1}, {pi_of<Quad>() / 2}, {0}, 1};
    // gravity such that the period is one second
    const Quad root = 2 * pi_of<Quad>() / a;
    spec.chain->gravity = root * root;
    const auto reference = reference_end(spec, {1, 1}, 1e-26, never);
    EXPECT_LT(static_cast<double>(abs(Quad(reference.end[0].theta - pi_of<Quad>() / 2))), 3e-33);  // measured 4e-34
    EXPECT_LT(static_cast<double>(abs(reference.end[0].omega)), 5e-32);                            // measured 6e-33
}

TEST(Reference, OfARunWithStabilisedRodsIsThatOfTheTrueMotion) {
    auto rods = chain({30, 20});
    rods.model = Model::constraints;
    rods.method = "rk4";
    const auto reference = reference_end(rods, {1, 1}, 1e-26, never);
    rods.stabilise = Stabilise::projection;
    const auto same = reference_end(rods, {1, 1}, 1e-26, never);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(same.end[i].theta, reference.end[i].theta);
}

TEST(Reference, RefusesWhereTheTwoDisagree) {
    try {
        reference_end(chain({90, 90}), {3, 1}, 1e-40, never);
        FAIL() << "it agrees to more digits than there are";
    } catch (const Error& fault) {
        EXPECT_EQ(fault.code(), ExitCode::method_failed);
        EXPECT_NE(std::string(fault.what()).find("no reference"), std::string::npos) << fault.what();
    }
}

TEST(Reference, OfAMechanismByTwoTolerances) {
    // a mass that circles on a spring of rest length 0, without gravity: x = cos t, y = sin t
    MotionSpec spec;
    spec.model = Model::mechanism;
    spec.parts.emplace();
    spec.parts->particles.push_back({1, Place<Quad>(1, 0), Place<Quad>(0, 1)});
    spec.parts->forces.emplace_back(Spring<Quad>{0, Place<Quad>(0, 0), 1, 0, 0});
    const auto reference = reference_end(spec, {2, 1}, 1e-26, never);
    const Quad x = cos(Quad(2)), y = sin(Quad(2));
    const auto& end = reference.end.at(0);
    for (const Quad& error : {Quad(end.x - x), Quad(end.y - y), Quad(end.vx + y), Quad(end.vy - x)})
        EXPECT_LT(static_cast<double>(abs(error)), 4e-34);  // measured 5e-35
}

TEST(PlaceError, IsTheLargestDistanceAndNoNumberWhereThereIsNone) {
    Bobs<double> one(2);
    auto other = one;
    other[0].x = 3;
    other[0].y = -4;
    other[1].y = 1;
    EXPECT_EQ(place_error(one, other), 5);
    other[0].x = std::nan("");
    EXPECT_TRUE(std::isnan(place_error(one, other)));
}

TEST(Reference, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(reference_end(chain({90, 90}), {10, 1}, 1, stop), Error);
}

}  // namespace reference_test
}  // namespace doppel

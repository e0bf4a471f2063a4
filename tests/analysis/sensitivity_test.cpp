#include "analysis/reference.hpp"
#include "base/error.hpp"
#include "integrate/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace sensitivity_test {

const std::atomic<bool> never = false;

double sensitivity(const std::vector<double>& angle_deg, const Rational& seconds) {
    MotionSpec spec;
    spec.chain = from_rest(angle_deg).cast<Quad>();
    return reference_end(spec, seconds, never).sensitivity;
}

TEST(Sensitivity, OfTheFourProblems) {
    // by tangent equations in dual numbers, once: 80.25, 20.59, 319.7, 1043.6; in another program 80, 21, 320, 1040
    EXPECT_NEAR(sensitivity({90, 90}, {10, 1}), 80.25, 0.005);
    EXPECT_NEAR(sensitivity({30, 0}, {60, 1}), 20.59, 0.005);
    EXPECT_NEAR(sensitivity({150, 90}, {5, 1}), 319.7, 0.05);
    EXPECT_NEAR(sensitivity({120, 0, 0}, {5, 1}), 1043.6, 0.05);
}

TEST(Sensitivity, OfSmallSwingsInClosedForm) {
    // one link near its rest: θ(t) = θ(0) cos ωt; near the upright: cosh ωt
    const double rate = std::sqrt(9.8);
    EXPECT_NEAR(sensitivity({1e-7}, {2, 1}), std::abs(std::cos(2 * rate)), 1e-10);
    EXPECT_NEAR(sensitivity({180}, {6, 1}) / std::cosh(6 * rate), 1, 1e-10);  // of 7e7
}

TEST(Sensitivity, IsOfChainsOfPointMassesAlone) {
    MotionSpec spec;
    spec.chain = from_rest({90, 90}).cast<Quad>();
    spec.physical = physical(*spec.chain);
    EXPECT_TRUE(std::isnan(reference_end(spec, {1, 10}, never).floor()));
}

}  // namespace sensitivity_test
}  // namespace doppel

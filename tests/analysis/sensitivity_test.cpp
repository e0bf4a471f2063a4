#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "base/error.hpp"
#include "integrate/motion.hpp"
#include "integrate/pendulums.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace sensitivity_test {

const std::atomic<bool> never = false;

TEST(Sensitivity, OfTheFourProblems) {
    // by finite differences in another program: 80, 21, 320, 1040
    EXPECT_NEAR(angle_sensitivity(from_rest({90, 90}), 10, never), 80, 1);      // measured 80.25
    EXPECT_NEAR(angle_sensitivity(from_rest({30, 0}), 60, never), 21, 0.5);     // 20.59
    EXPECT_NEAR(angle_sensitivity(from_rest({150, 90}), 5, never), 320, 1);     // 319.7
    EXPECT_NEAR(angle_sensitivity(from_rest({120, 0, 0}), 5, never), 1040, 5);  // 1043.6
}

TEST(Sensitivity, OfSmallSwingsInClosedForm) {
    // one link near its rest: θ(t) = θ(0) cos ωt; near the upright: cosh ωt, over many parts of the time
    const double rate = std::sqrt(9.8);
    EXPECT_NEAR(angle_sensitivity(from_rest({1e-4}), 2, never), std::abs(std::cos(2 * rate)),
                3e-11);                                                            // measured 5.1e-12
    const double grown = std::cosh(6 * rate);                                      // 7e7
    EXPECT_NEAR(angle_sensitivity(from_rest({180}), 6, never) / grown, 1, 2e-11);  // measured 3.1e-12
}

TEST(Sensitivity, IsWhatAnErrorGrowsBy) {
    // a central difference in quad, of the angle that tells the most
    const auto end = [](double off) {
        MotionSpec spec;
        spec.chain = from_rest({90, 90}).cast<Quad>();
        spec.chain->angle[0] += Quad(off);
        spec.method = "taylor";
        spec.precision = Precision::in_quad;
        spec.tolerance = parse_quad("1e-28");
        spec.sample_interval = {3, 1};
        spec.follows_turns = false;
        const auto motion = make_motion(spec);
        motion->advance(never);
        return motion->observe().exact;
    };
    const double off = 1e-8, grown = angle_error(end(off), end(-off)) / (2 * off);
    const double sensitivity = angle_sensitivity(from_rest({90, 90}), 3, never);
    EXPECT_GE(sensitivity, grown * (1 - 1e-8));
    EXPECT_LT(sensitivity, 10 * grown);
}

TEST(Sensitivity, StopsWhenAsked) {
    const std::atomic<bool> stop = true;
    EXPECT_THROW(angle_sensitivity(from_rest({90, 90}), 10, stop), Error);
}

}  // namespace sensitivity_test
}  // namespace doppel

// The start fitted to a track, compared with the true start.
#include "fit/start.hpp"

#include "track/support.hpp"

#include <gtest/gtest.h>

namespace doppel::start_test {

using namespace test;

/// The fitted start of a simulation beside the track of the rods, with errors below `angle` and `rate`.
FittedStart start_of(const MotionSpec& twin, double angle, double rate, double noise = 0, double offset = 0) {
    const auto text = csv_of_motion(swinging_rods(), 1002, noise, offset);
    const auto track = std::make_shared<const Track>(tracks_of_texts({"swing.csv"}, {text}));
    const auto start = fit_start(twin, replay_from(track, std::nullopt, {}), never_stop);
    EXPECT_NEAR(start.angle[0], 1, angle);
    EXPECT_NEAR(start.angle[1], -2, angle);
    EXPECT_NEAR(start.rate[0], 3, rate);
    EXPECT_NEAR(start.rate[1], 5, rate);
    return start;
}

TEST(FitStart, FindsStartAndOffsets) {
    const auto start = start_of(swinging_rods(), 1e-6, 1e-5, 0, 0.01);
    EXPECT_NEAR(start.offset[0], 0.01, 1e-6);
    EXPECT_NEAR(start.offset[1], -0.01, 1e-6);
    EXPECT_NEAR(start.seconds, 2, 1e-9);
    EXPECT_LT(start.rms, 1e-6);
    start_of(swinging_rods(), 2e-4, 3e-3, 1e-3);  // measured 5e-5, 6e-4
}

/// For any method of the simulation: the start is correct for its own motion.
TEST(FitStart, OfAnyMethod) {
    auto twin = swinging_rods();
    twin.method = "rk4";
    twin.steps_per_sample = 20;
    start_of(twin, 1e-6, 1e-5);
}

/// Point masses cannot follow this motion: the fit uses the part that they can follow, and reports its length.
TEST(FitStart, OfAModelThatCannotFollow) {
    auto twin = swinging_rods();
    twin.physical = physical(*twin.chain);
    const auto start = start_of(twin, 0.3, 3);
    EXPECT_GT(start.seconds, 0);
    EXPECT_LT(start.seconds, 2);
    EXPECT_LT(start.rms, 0.1);
}

}  // namespace doppel::start_test

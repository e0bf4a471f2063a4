#include "scene/scene.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel::whip_test {

double speed(const Bob<double>& bob) {
    return std::hypot(bob.vx, bob.vy);
}

/// The root mean square of the angles between adjacent links, rad.
double bend(const Bobs<double>& bobs) {
    double sum = 0;
    for (std::size_t i = 1; i < bobs.size(); ++i) sum += std::pow(bobs[i].theta - bobs[i - 1].theta, 2);
    return std::sqrt(sum / static_cast<double>(bobs.size() - 1));
}

TEST(Whip256, IsSmoothUntilItCracksAndThenDiverges) {
    const auto scene = scene_of("whip-256");
    PairRun pair(scene);
    double fastest = 0;
    for (double time = 0; time < 4;) {
        const auto now = pair.next(never);
        time = scene.time(now.sample);
        fastest = std::max(fastest, speed(now.a.bobs.back()));
        if (now.sample == 360) {
            EXPECT_LT(bend(now.a.bobs), 0.05);  // measured 0.036
            EXPECT_LT(now.distance, 0.2);       // measured 0.12
        }
        if (now.sample == 480) {
            EXPECT_GT(bend(now.a.bobs), 1);
            EXPECT_GT(now.distance, 10);
        }
    }
    EXPECT_NEAR(fastest, 23.5, 1);
    EXPECT_GT(pair.other_cpu_s(), 0) << "its sides are large enough for two threads";
}

/// Both pendulums of a small pair run on one thread; the assignment does not change any number.
TEST(Whip256, GivesTheSameNumbersOnTwoThreads) {
    const auto scene = scene_of("whip-256");
    PairRun pair(scene);
    SideRun b(scene, scene.b, 'b');
    for (int i = 0; i < 60; ++i) {
        const auto now = pair.next(never);
        const auto alone = b.next(never);
        ASSERT_EQ(now.b.energy, alone.energy);
        for (std::size_t k = 0; k < alone.bobs.size(); ++k) {
            ASSERT_EQ(now.b.bobs[k].x, alone.bobs[k].x);
            ASSERT_EQ(now.b.bobs[k].vy, alone.bobs[k].vy);
        }
    }
    const auto few = scene_of("whip");
    PairRun small(few);
    small.next(never);
    small.next(never);
    EXPECT_EQ(small.other_cpu_s(), 0);
}

}  // namespace doppel::whip_test

#include "analysis/difference.hpp"

#include "analysis/watched_motion.hpp"
#include "integrate/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace difference_test {

TEST(Distance, CountsMassesPlacesAndVelocities) {
    Bobs<double> a(2), b(2);
    EXPECT_EQ(state_space_distance(a, b), 0);
    b[0].mass = 2;
    b[1].x = 3;
    b[0].vy = 6;
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
    b[0].theta = b[1].omega = 100;  // not part of the distance: x, y and their rates contain the same information
    EXPECT_DOUBLE_EQ(state_space_distance(a, b), 7);
}

TEST(Distance, LogRatioIsEmptyWhereThereIsNone) {
    EXPECT_FALSE(log_ratio(1, 0));
    EXPECT_FALSE(log_ratio(0, 1));
    EXPECT_DOUBLE_EQ(log_ratio(std::exp(2.0), 1).value(), 2);
}

TEST(ErrorScale, IsOfTheRangeWhereTheStartHasNoEnergy) {
    const auto scale = [](const Pendulum<double>& p) {
        return ErrorScale(Course(stepping(Model::angles, "euler", p, 120)).observe(), p.potential_range(), p.reach())
            .energy;
    };
    EXPECT_DOUBLE_EQ(scale(released(90, 90)), 2 * 9.8 * (1 * 1 + 1 * 2));                 // cos 90° is 6e-17, not 0
    EXPECT_NEAR(scale(released(90.003, 90)), 2 * 9.8 * std::sin(radians(0.003)), 7e-16);  // measured 1.2e-16
    EXPECT_DOUBLE_EQ(scale(released(0, 0)), 29.4);
}

}  // namespace difference_test
}  // namespace doppel

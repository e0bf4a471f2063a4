#include "numeric/subnormals.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace doppel {
namespace subnormals_test {

TEST(NoSubnormals, TakesThemForZeroAndOnlyWhileItLives) {
    volatile double least = std::numeric_limits<double>::min(), tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_GT(least / 2, 0);
    {
        const NoSubnormals here;
        volatile const double half = least / 2, sum = tiny + tiny, whole = least * 2;
        EXPECT_EQ(half, 0);
        EXPECT_EQ(sum, 0);
        EXPECT_GT(whole, 0);
    }
    EXPECT_GT(least / 2, 0);
}

}  // namespace subnormals_test
}  // namespace doppel

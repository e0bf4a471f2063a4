#include "numeric/subnormals.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace doppel::subnormals_test {

TEST(NoSubnormals, TreatsThemAsZeroDuringItsLifetime) {
    volatile double minimum = std::numeric_limits<double>::min(), tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_GT(minimum / 2, 0);
    {
        const NoSubnormals here;
        volatile const double half = minimum / 2, sum = tiny + tiny, whole = minimum * 2;
        EXPECT_EQ(half, 0);
        EXPECT_EQ(sum, 0);
        EXPECT_GT(whole, 0);
    }
    EXPECT_GT(minimum / 2, 0);
}

}  // namespace doppel::subnormals_test

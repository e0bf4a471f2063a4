#include "numeric/lanes.hpp"

#include "numeric/support.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace doppel::lanes_test {

TEST(Lanes, RoundLikeDouble) {
    std::mt19937_64 random(1);
    using Side = Lanes<4>;
    const auto any = [&] {
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(random), static_cast<int>(random() % 40) - 20);
    };
    for (int i = 0; i < 20'000; ++i) {
        Side a, b;
        for (int lane = 0; lane < 4; ++lane) a.set(lane, any()), b.set(lane, any());
        for (int lane = 0; lane < 4; ++lane) {
            const double x = a[lane], y = b[lane];
            ASSERT_EQ(bits((a + b)[lane]), bits(x + y));
            ASSERT_EQ(bits((a - b)[lane]), bits(x - y));
            ASSERT_EQ(bits((a * b + a)[lane]), bits(x * y + x));  // no fused multiply-add
            ASSERT_EQ(bits((a / b)[lane]), bits(x / y));
            ASSERT_EQ(bits(sqrt(abs(a))[lane]), bits(std::sqrt(std::abs(x))));
            ASSERT_EQ(bits((-a)[lane]), bits(-x));
        }
    }
}

TEST(Lanes, ConstantsKeepTheirSign) {
    EXPECT_EQ(bits(Lanes<8>(-0.0)[5]), bits(-0.0));
    EXPECT_EQ(bits(Lanes<8>(0)[5]), bits(0.0));
    EXPECT_EQ(bits((-Lanes<4>(0.0))[1]), bits(-0.0));
}

TEST(Lanes, SelectDecidesLaneByLane) {
    Lanes<4> a(1);
    a.set(2, 3);
    a.set(3, std::numeric_limits<double>::quiet_NaN());
    const auto small = a <= Lanes<4>(2);
    EXPECT_FALSE(all_of(small));
    EXPECT_TRUE(all_of(Lanes<4>(1) < Lanes<4>(2)));
    const auto chosen = select(small, Lanes<4>(10), Lanes<4>(20));
    EXPECT_EQ(chosen[0], 10);
    EXPECT_EQ(chosen[1], 10);
    EXPECT_EQ(chosen[2], 20);
    EXPECT_EQ(chosen[3], 20);  // NaN is not smaller
}

TEST(Lanes, TheLargerIsNaNIfEitherIs) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [a, b, expected] :
         {std::array{1.0, 2.0, 2.0}, {2.0, 1.0, 2.0}, {nan, 1.0, nan}, {1.0, nan, nan}}) {
        EXPECT_EQ(bits(greater(a, b)), bits(expected));
        Lanes<4> wide(5);
        wide.set(2, a);
        const auto all = greater(wide, Lanes<4>(b));
        EXPECT_EQ(bits(all[2]), bits(expected));
        EXPECT_EQ(std::isnan(all[1]), std::isnan(b));
    }
}

}  // namespace doppel::lanes_test

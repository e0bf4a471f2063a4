#include "image/picture.hpp"

#include <gtest/gtest.h>

namespace doppel::picture_test {

TEST(Rect, UnitedHoldsBoth) {
    EXPECT_EQ(united({1, 2, 3, 4}, {10, 0, 12, 3}), (Rect{1, 0, 12, 4}));
    EXPECT_EQ(united({1, 2, 3, 4}, {}), (Rect{1, 2, 3, 4}));
    EXPECT_EQ(united({7, 7, 7, 9}, {1, 2, 3, 4}), (Rect{1, 2, 3, 4}));
}

TEST(Rect, CommonIsWhatBothCover) {
    EXPECT_EQ(intersection({0, 0, 10, 10}, {5, 6, 20, 8}), (Rect{5, 6, 10, 8}));
    EXPECT_TRUE(intersection({0, 0, 5, 5}, {5, 0, 9, 5}).empty());
    EXPECT_TRUE(intersection({0, 0, 1, 1}, {3, 3, 4, 4}).empty());
}

}  // namespace doppel::picture_test

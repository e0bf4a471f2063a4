#include "analysis/share_at_least.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace share_at_least_test {

TEST(ShareAtLeast, OfAllHitsInClosedForm) {
    for (const int n : {1, 20, 500}) EXPECT_NEAR(share_at_least(n, n), std::pow(0.05, 1.0 / n), 1e-12) << n;
    // one hit of n: 1 − (1 − p)^n = 0.05
    EXPECT_NEAR(share_at_least(1, 20), 1 - std::pow(0.95, 1.0 / 20), 1e-12);
    EXPECT_EQ(share_at_least(0, 20), 0);
    EXPECT_EQ(share_at_least(0, 0), 0);
    // Clopper & Pearson's tables: 490 of 500
    EXPECT_NEAR(share_at_least(490, 500), 0.96634, 1e-4);
}

}  // namespace share_at_least_test
}  // namespace doppel

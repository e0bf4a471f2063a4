#include "numeric/portable_math.hpp"

#include "numeric/quad.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace doppel {
namespace portable_math_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The error in units of the last place of the exact value.
double ulps(double value, const Quad& exact) {
    const double near = std::abs(static_cast<double>(exact));
    const double unit = std::nextafter(near, infinity) - near;
    return std::abs(static_cast<double>(Quad(Quad(value) - exact))) / unit;
}

TEST(PortableMath, LogarithmIsRightToAnUlp) {
    using std::log;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> exponents(-1070, 1023), near_one(0.5, 2);
    double worst = 0;
    for (int i = 0; i < 40'000; ++i)
        for (const double x : {std::exp2(exponents(random)), near_one(random)})
            worst = std::max(worst, ulps(portable_log(x), Quad(log(Quad(x)))));
    EXPECT_LT(worst, 1);
    EXPECT_EQ(portable_log(1), 0);
    EXPECT_EQ(portable_log(0), -infinity);
    EXPECT_EQ(portable_log(infinity), infinity);
    EXPECT_TRUE(std::isnan(portable_log(-1)));
    EXPECT_TRUE(std::isnan(portable_log(std::nan(""))));
}

TEST(PortableMath, ExponentialIsRightToAnUlp) {
    using std::exp;
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> wide(-705, 709), narrow(-1, 1);
    double worst = 0;
    for (int i = 0; i < 40'000; ++i)
        for (const double x : {wide(random), narrow(random)})
            worst = std::max(worst, ulps(portable_exp(x), Quad(exp(Quad(x)))));
    EXPECT_LT(worst, 1);
    EXPECT_EQ(portable_exp(0), 1);
    EXPECT_EQ(portable_exp(-infinity), 0);
    EXPECT_EQ(portable_exp(infinity), infinity);
    EXPECT_TRUE(std::isnan(portable_exp(std::nan(""))));
}

TEST(PortableMath, PowersOfStepControlAreRight) {
    for (double x = 1e-12; x < 1e6; x *= 3.7)
        for (const double y : {-0.125, 0.08, 1.0 / 3})
            EXPECT_NEAR(portable_pow(x, y) / std::pow(x, y), 1, 2e-15) << x << "^" << y;
    EXPECT_EQ(portable_pow(0, -0.2), infinity);
    EXPECT_EQ(portable_pow(0, 0.2), 0);
}

TEST(PortableMath, AngleIsRightToAnUlpAndAHalfInEveryQuadrant) {
    using std::atan2;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> side(-1, 1), exponents(-300, 300);
    double worst = 0;
    for (int i = 0; i < 40'000; ++i) {
        const double x = side(random), y = side(random), far = y * std::exp2(exponents(random));
        worst = std::max({worst, ulps(portable_atan2(y, x), Quad(atan2(Quad(y), Quad(x)))),
                          ulps(portable_atan2(far, x), Quad(atan2(Quad(far), Quad(x))))});
    }
    EXPECT_LT(worst, 1.5);  // measured 1.29
}

TEST(PortableMath, AngleOfZerosAndInfinitiesIsThatOfTheCLibrary) {
    for (const double y : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 5e-324})
        for (const double x : {0.0, -0.0, 1.0, -1.0, infinity, -infinity, 5e-324}) {
            EXPECT_EQ(portable_atan2(y, x), std::atan2(y, x)) << y << ", " << x;
            EXPECT_EQ(std::signbit(portable_atan2(y, x)), std::signbit(std::atan2(y, x))) << y << ", " << x;
        }
    EXPECT_TRUE(std::isnan(portable_atan2(std::nan(""), 1)));
}

}  // namespace portable_math_test
}  // namespace doppel

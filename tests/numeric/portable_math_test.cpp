#include "numeric/portable_math.hpp"

#include "numeric/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace doppel::portable_math_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The largest error of a function of one argument over samples of two ranges, in units of the last place.
template <class Function, class Exact, class First, class Second>
double worst_ulps(const Function& function, const Exact& exact, const First& first, const Second& second) {
    std::mt19937_64 random(5);
    double worst = 0;
    for (int i = 0; i < 40'000; ++i)
        for (const double x : {first(random), second(random)})
            worst = std::max(worst, ulps(function(x), exact(Quad(x))));
    return worst;
}

using Range = std::uniform_real_distribution<double>;

TEST(PortableMath, LogarithmIsRightToAnUlp) {
    const auto exponents = [](auto& random) { return std::exp2(Range(-1070, 1023)(random)); };
    const auto near_one = [](auto& random) { return Range(0.5, 2)(random); };
    EXPECT_LT(worst_ulps(
                  portable_log, [](const Quad& x) { return Quad(log(x)); }, exponents, near_one),
              1);
    EXPECT_EQ(portable_log(1), 0);
    EXPECT_EQ(portable_log(0), -infinity);
    EXPECT_EQ(portable_log(infinity), infinity);
    for (const double x : {-1.0, std::nan("")}) EXPECT_TRUE(std::isnan(portable_log(x))) << x;
}

TEST(PortableMath, ExponentialIsRightToAnUlp) {
    const auto wide = [](auto& random) { return Range(-705, 709)(random); };
    const auto narrow = [](auto& random) { return Range(-1, 1)(random); };
    EXPECT_LT(worst_ulps(
                  portable_exp, [](const Quad& x) { return Quad(exp(x)); }, wide, narrow),
              1);
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

}  // namespace doppel::portable_math_test

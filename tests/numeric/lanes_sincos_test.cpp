#include "numeric/lanes.hpp"
#include "numeric/quad.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace doppel {
namespace lanes_sincos_test {

constexpr double pi = 3.14159265358979323846;

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

/// Evenly within ±largest, and as close to the quarters of the circle as doubles come.
std::vector<double> angles(double largest, int count) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> some(-largest, largest);
    std::vector<double> all{0.0, -0.0, 1e-300, 1e-9, pi, pi / 4};
    for (int i = 0; i < count; ++i) all.push_back(some(random));
    for (int quarter = 1; quarter * pi / 2 < largest && quarter < 64; ++quarter)
        for (const double beside : {-1e-5, -1e-12, 0.0, 1e-12, 1e-5}) all.push_back(quarter * pi / 2 + beside);
    while (all.size() % 8 != 0) all.push_back(1);
    return all;
}

template <int width>
Lanes<width> load(const std::vector<double>& from, std::size_t first) {
    Lanes<width> side;
    for (int lane = 0; lane < width; ++lane) side.set(lane, from[first + static_cast<std::size_t>(lane)]);
    return side;
}

/// The error in units of the last place of the exact value.
double ulps(double value, const Quad& exact) {
    const double near = std::abs(static_cast<double>(exact));
    const double unit = std::nextafter(near, std::numeric_limits<double>::infinity()) - near;
    return std::abs(static_cast<double>(Quad(Quad(value) - exact))) / unit;
}

double worst_ulps(double largest, int count) {
    using std::cos;
    using std::sin;
    double worst = 0;
    const auto all = angles(largest, count);
    for (std::size_t i = 0; i < all.size(); i += 8) {
        const LanesSinCos<Lanes<8>> turn(load<8>(all, i));
        for (int lane = 0; lane < 8; ++lane) {
            const Quad angle(all[i + static_cast<std::size_t>(lane)]);
            worst = std::max({worst, ulps(turn.sin[lane], Quad(sin(angle))), ulps(turn.cos[lane], Quad(cos(angle)))});
        }
    }
    return worst;
}

TEST(LanesSinCos, IsRightToAnUlp) {
    EXPECT_LT(worst_ulps(2 * pi, 40'000), 0.8);  // measured 0.751
    EXPECT_LT(worst_ulps(1e5, 20'000), 0.8);     // measured 0.775
}

TEST(LanesSinCos, SineIsOddAndCosineEvenToTheLastBit) {
    const auto all = angles(20, 50'000);
    for (std::size_t i = 0; i < all.size(); i += 8) {
        const auto angle = load<8>(all, i);
        const LanesSinCos<Lanes<8>> turn(angle), mirrored(-angle);
        for (int lane = 0; lane < 8; ++lane) {
            ASSERT_EQ(mirrored.sin[lane], -turn.sin[lane]) << angle[lane];
            ASSERT_EQ(mirrored.cos[lane], turn.cos[lane]) << angle[lane];
        }
    }
}

TEST(LanesSinCos, GivesTheSameBitsAtEveryWidth) {
    const auto all = angles(20, 10'000);
    for (std::size_t i = 0; i < all.size(); i += 8) {
        const LanesSinCos<Lanes<8>> eight(load<8>(all, i));
        const LanesSinCos<Lanes<4>> four(load<4>(all, i + 4));
        const LanesSinCos<Lanes<2>> two(load<2>(all, i + 6));
        for (int lane = 0; lane < 2; ++lane) {
            ASSERT_EQ(bits(eight.sin[6 + lane]), bits(two.sin[lane]));
            ASSERT_EQ(bits(eight.sin[6 + lane]), bits(four.sin[2 + lane]));
            ASSERT_EQ(bits(eight.cos[6 + lane]), bits(two.cos[lane]));
            ASSERT_EQ(bits(eight.cos[6 + lane]), bits(four.cos[2 + lane]));
        }
    }
}

TEST(LanesRoughLog2, IsWithinAStraightLineOfTheLogarithm) {
    double worst_log = 0, worst_power = 0;
    for (double x = 1e-300; x < 1e300; x *= 1.0123) {
        const Lanes<4> exponent(std::log2(x));
        worst_log = std::max(worst_log, std::abs(rough_log2(Lanes<4>(x))[1] - exponent[1]));
        worst_power = std::max(worst_power, std::abs(rough_exp2(exponent)[2] / x - 1));
        ASSERT_NEAR(rough_exp2(rough_log2(Lanes<4>(x)))[3] / x, 1, 3e-12);  // measured 4.5e-13
    }
    EXPECT_LT(worst_log, 0.05);    // measured 0.0431
    EXPECT_LT(worst_power, 0.04);  // measured 0.0303
    EXPECT_NEAR(rough_log2(Lanes<4>(0))[0], -1023, 0.05);
}

}  // namespace lanes_sincos_test
}  // namespace doppel

#include "numeric/sin_cos.hpp"

#include "numeric/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace doppel::sin_cos_test {

constexpr double pi = 3.14159265358979323846;

/// Uniform within ±largest, and as close to the multiples of π/2 as doubles allow.
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

double worst_ulps(double largest, int count) {
    using std::cos;
    using std::sin;
    double worst = 0;
    const auto all = angles(largest, count);
    for (std::size_t i = 0; i < all.size(); i += 8) {
        const SinCos<Lanes<8>> turn(load<8>(all, i));
        for (int lane = 0; lane < 8; ++lane) {
            const Quad angle(all[i + static_cast<std::size_t>(lane)]);
            worst = std::max({worst, ulps(turn.sin[lane], Quad(sin(angle))), ulps(turn.cos[lane], Quad(cos(angle)))});
        }
    }
    return worst;
}

TEST(SinCos, IsRightToAnUlp) {
    EXPECT_LT(worst_ulps(2 * pi, 40'000), 0.8);  // measured 0.751
    EXPECT_LT(worst_ulps(1e5, 20'000), 0.8);     // measured 0.775
}

TEST(SinCos, SineIsOddAndCosineEvenToTheLastBit) {
    const auto all = angles(20, 50'000);
    for (std::size_t i = 0; i < all.size(); i += 8) {
        const auto angle = load<8>(all, i);
        const SinCos<Lanes<8>> turn(angle), mirrored(-angle);
        for (int lane = 0; lane < 8; ++lane) {
            ASSERT_EQ(mirrored.sin[lane], -turn.sin[lane]) << angle[lane];
            ASSERT_EQ(mirrored.cos[lane], turn.cos[lane]) << angle[lane];
        }
    }
}

template <int width>
void expect_the_bits_of_double(const std::vector<double>& all) {
    for (std::size_t i = 0; i < all.size(); i += width) {
        const SinCos<Lanes<width>> lanes(load<width>(all, i));
        for (int lane = 0; lane < width; ++lane) {
            const SinCos<double> alone(all[i + static_cast<std::size_t>(lane)]);
            ASSERT_EQ(bits(alone.sin), bits(lanes.sin[lane])) << width << " lanes: " << all[i];
            ASSERT_EQ(bits(alone.cos), bits(lanes.cos[lane])) << width << " lanes: " << all[i];
        }
    }
}

TEST(SinCos, OfADoubleIsThatOfALaneAtEveryWidth) {
    auto all = angles(20, 5'000);
    for (const double beyond : {1e5, 1.1e5, -3e8, 1e300, HUGE_VAL, std::nan("")}) all.push_back(beyond);
    while (all.size() % 8 != 0) all.push_back(2e7);
    expect_the_bits_of_double<2>(all);
    expect_the_bits_of_double<4>(all);
    expect_the_bits_of_double<8>(all);
    Eigen::VectorXd sin(all.size()), cos(all.size());
    TakeSinCos()(all, sin, cos);
    for (std::size_t k = 0; k < all.size(); ++k) {
        ASSERT_EQ(bits(SinCos<double>(all[k]).sin), bits(sin[static_cast<Eigen::Index>(k)])) << all[k];
        ASSERT_EQ(bits(SinCos<double>(all[k]).cos), bits(cos[static_cast<Eigen::Index>(k)])) << all[k];
    }
    EXPECT_EQ(SinCos<double>(1e300).sin, std::sin(1e300));
    EXPECT_TRUE(std::isnan(SinCos<double>(std::nan("")).cos));
}

TEST(TurningAngle, AgreesWithTheSineWithinItsRange) {
    // just below the largest turn, the series must still give the sine and cosine of the sum
    for (double theta = -3; theta < 3; theta += 0.01) {
        const SinCos<double> start(theta);
        TurningAngle<double> angle{start.sin, start.cos};
        const double d = largest_turn;
        angle.turn(d, d * d);
        EXPECT_NEAR(angle.sin, std::sin(theta + d), 4e-16);  // measured 2.2e-16
        EXPECT_NEAR(angle.cos, std::cos(theta + d), 4e-16);
    }
}

TEST(SinCos, OfStagesAreRotatedIfNearAndOtherwiseEvaluated) {
    using std::cos;
    using std::sin;
    using Column = Eigen::Matrix<double, 3, 1>;
    StageAngles<double, 3> stages;
    const Column start(0.3, -2.0, 50.0), moved(0.3 + 0.9 / 1024, -2.0 - 1.0 / 1024, 50.4);
    Column s, c;
    stages.start()(start, s, c);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(s[i], SinCos<double>(start[i]).sin);
    stages.stage()(moved, s, c);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(s[i], static_cast<double>(Quad(sin(Quad(moved[i])))), 2.3e-16) << i;  // measured 1.2e-16
        EXPECT_NEAR(c[i], static_cast<double>(Quad(cos(Quad(moved[i])))), 2.3e-16) << i;  // measured 1.3e-16
    }
    EXPECT_EQ(s[2], SinCos<double>(moved[2]).sin);
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

}  // namespace doppel::sin_cos_test

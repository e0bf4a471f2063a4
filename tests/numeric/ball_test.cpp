#include "numeric/ball.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace doppel::ball_test {

/// Planted faults.
struct NoRounding : Counted {
    static constexpr double rounding = 0;
};
struct RoundingInwards : Counted {
    static constexpr double rounding = -1;
};
struct NoRemainder : Counted {
    static constexpr double series_remainder = 0;
};

template <class B>
bool contains(const B& ball, const Wide& number) {
    const Wide off = abs(Wide(ball.center) - number);
    return off <= Wide(ball.radius);
}

/// The number of results of random expressions, of `count`, that the balls do not contain.
template <class Scalar, class Count>
int misses(int count) {
    using B = Ball<Scalar, Count>;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> some(0.1, 10), within(-1, 1);
    int all = 0;
    for (int i = 0; i < count; ++i) {
        const double x = some(random), y = some(random), spread = i % 2 == 0 ? 0 : 1e-3;
        const B a(Scalar(x), spread), b(Scalar(y), spread);
        const Wide u = Wide(x) + spread * within(random), v = Wide(y) + spread * within(random);
        all += contains(a + b, u + v) ? 0 : 1;
        all += contains(a - b, u - v) ? 0 : 1;
        all += contains(a * b, u * v) ? 0 : 1;
        all += contains(a / b, u / v) ? 0 : 1;
        all += contains(sqrt(a), Wide(sqrt(u))) ? 0 : 1;
        all += contains(sqrt(a - a), Wide(sqrt(Wide(abs(u - Wide(x)))))) ? 0 : 1;
        all += contains(a / (a * b + b) - sqrt(b), Wide(u / (u * v + v) - sqrt(v))) ? 0 : 1;
    }
    return all;
}

TEST(Ball, ContainsTheResultsOfItsNumbers) {
    EXPECT_EQ((misses<double, Counted>(2000)), 0);
    EXPECT_EQ((misses<Quad, Counted>(300)), 0);
    EXPECT_GT((misses<double, NoRounding>(2000)), 1000);
    EXPECT_GT((misses<double, RoundingInwards>(2000)), 1000);
    EXPECT_GT((misses<Quad, NoRounding>(300)), 100);
}

TEST(Ball, IsNotMuchLargerThanNecessary) {
    const Ball<double> third = Ball<double>(1) / Ball<double>(3);
    EXPECT_LT(third.radius, 1e-16);
    EXPECT_LT((third * third).radius, 2e-16);
    EXPECT_LT(sqrt(Ball<double>(2)).radius, 1e-15);
    EXPECT_LT(sqrt(Ball<Wide>(2)).radius, 1e-76);
}

TEST(Ball, DivisionByABallWithZeroIsUnbounded) {
    EXPECT_FALSE(std::isfinite((Ball<double>(1) / Ball<double>(0.5, 0.6)).radius));
    EXPECT_FALSE(std::isfinite((Ball<Quad>(1) / Ball<Quad>(0)).radius));
}

TEST(Ball, BoundsAreDoublesOnBothSides) {
    for (const char* text : {"0.1", "-0.1", "90.003", "1e-30", "-12345.678901234567890123"}) {
        const auto ball = ball_of_decimal(text);
        const Wide exact(text);
        EXPECT_LE(Wide(ball.low()), exact) << text;
        EXPECT_GE(Wide(ball.high()), exact) << text;
        EXPECT_LE(ball.high() - ball.low(), 2e-15 * std::abs(ball.high())) << text;
    }
    EXPECT_EQ(Ball<Quad>(0).low(), 0);
    EXPECT_EQ(Ball<Quad>(0).high(), 0);
    EXPECT_EQ(Ball<double>(1.5).high(), 1.5);
}

TEST(Ball, ADecimalIsItsFractionNotTheNearestDouble) {
    const auto g = ball_of_decimal("9.8");
    EXPECT_TRUE(contains(g, Wide(49) / 5));
    EXPECT_FALSE(contains(g, Wide(9.8)));
    EXPECT_TRUE(contains(Ball<double>(ball_of_decimal("9.8")), Wide(49) / 5));
    EXPECT_TRUE(contains(ball_of_decimal("6.674e-11"), Wide("6.674e-11")));
    EXPECT_TRUE(contains(ball_of_decimal("-2.5e2"), Wide(-250)));
    // in doubles, the ball of an exact number is that number
    EXPECT_EQ(Ball<double>(Ball<Wide>(Wide(1.5))).radius, 0);
    EXPECT_FALSE(contains(Ball<double>(ball_of_decimal("9.8")), Wide(9.8) + Wide(2e-15)));
    // of more digits than quad has, all numbers that are the same quad
    EXPECT_GT(ball_of_decimal("0.33333333333333333333333333333333333").radius, 1e-35);
}

namespace mp = boost::multiprecision;
using Number320 = mp::number<mp::cpp_bin_float<320, mp::digit_base_2, void, int>, mp::et_off>;
using Wider = Ball<Number320>;

TEST(Ball, ADecimalContainsItsFractionInMoreBits) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 1000; ++i) {
        const auto digits = random() >> i % 64 | 1;
        const int exponent = i % 81 - 40;
        const auto ball = ball_of_decimal(std::to_string(digits) + "e" + std::to_string(exponent));
        Wider scale(1), exact{Number320(digits)};
        for (int k = 0; k < std::abs(exponent); ++k) scale *= Wider(10);
        exact = exponent < 0 ? exact / scale : exact * scale;
        EXPECT_LE((exact - Wider(Number320(ball.center))).size(), ball.radius) << digits << 'e' << exponent;
        EXPECT_LE(ball.radius, 1e-76 * ball.size() + 1e-280);
    }
}

/// Σ ±1 / ((2k + 1) n^(2k + 1)); alternating, so the rest is below its first term.
Wider atan_of_inverse(int n) {
    Wider power = Wider(1) / Wider(n), sum(0);
    for (int k = 0;; ++k) {
        const Wider term = power / Wider(2 * k + 1);
        if (term.size() < 1e-3 * Wider::roundoff) return sum.widened_by(term.size());
        sum += k % 2 == 0 ? term : -term;
        power = power / Wider(n * n);
    }
}

TEST(Ball, PiIsThatOfMachin) {
    // π = 16 atan(1/5) − 4 atan(1/239), Machin 1706
    const auto pi = Wider(16) * atan_of_inverse(5) - Wider(4) * atan_of_inverse(239);
    const auto is_inside = [&](const auto& ball) {
        const Wider center(Number320(ball.center));
        return (pi - center).size() <= ball.radius;
    };
    EXPECT_TRUE(is_inside(pi_ball<Ball<double>>()));
    EXPECT_TRUE(is_inside(pi_ball<Ball<Quad>>()));
    EXPECT_TRUE(is_inside(pi_ball<Ball<Wide>>()));
    EXPECT_LT(pi_ball<Ball<Wide>>().radius, 1e-75);
}

/// The number of wrong sines and cosines, of 2 · 600.
template <class Scalar, class Count = Counted>
int wrong_sines() {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> some(-40, 40);
    int all = 0;
    for (int i = 0; i < 600; ++i) {
        const double angle = i < 100 ? 1e-3 * some(random) : some(random), spread = i % 3 == 0 ? 1e-6 : 0;
        const SinCos<Ball<Scalar, Count>> turn(Ball<Scalar, Count>(Scalar(angle), spread));
        for (const double at : {angle - 0.9 * spread, angle + 0.9 * spread}) {
            all += contains(turn.sin, Wide(sin(Wide(at)))) ? 0 : 1;
            all += contains(turn.cos, Wide(cos(Wide(at)))) ? 0 : 1;
        }
        if (turn.sin.radius > 1.01 * spread + 16 * (4 + std::abs(angle)) * Ball<Scalar>::roundoff) ++all;
    }
    return all;
}

TEST(Ball, ContainsSinesAndCosines) {
    EXPECT_EQ(wrong_sines<double>(), 0);
    EXPECT_EQ(wrong_sines<Quad>(), 0);
    EXPECT_GT((wrong_sines<double, NoRemainder>()), 300);
    EXPECT_GT((wrong_sines<double, NoRounding>()), 100);
    EXPECT_EQ(SinCos<Ball<double>>(Ball<double>(1e9)).sin.radius, 1) << "too large to reduce: all there is";
}

}  // namespace doppel::ball_test

#include "numeric/rational.hpp"

#include <gtest/gtest.h>

namespace doppel::rational_test {

TEST(Rational, ReadsWhatItsDigitsMean) {
    EXPECT_EQ(parse_rational("1/30000"), (Rational{1, 30000}));
    EXPECT_EQ(parse_rational("0.001"), (Rational{1, 1000}));
    EXPECT_EQ(parse_rational("2.5e-4"), (Rational{1, 4000}));
    EXPECT_EQ(parse_rational("37.5"), (Rational{75, 2}));
    EXPECT_EQ(parse_rational("-3"), (Rational{-3, 1}));
    EXPECT_EQ(parse_rational("1.5/0.5"), (Rational{3, 1}));
    EXPECT_EQ(parse_rational("1e3"), (Rational{1000, 1}));
}

TEST(Rational, RefusesWhatIsNoNumber) {
    for (const char* text : {"", "/", "1/", "/2", "1/0", "abc", "1.2.3", "1e", "1e+", "--1", "1e99999", "nan", "inf",
                             "0x10", "99999999999999999999", "1/2/3", " 1"})
        EXPECT_FALSE(parse_rational(text)) << text;
}

TEST(Rational, ComesFromTheDecimalsOfADouble) {
    EXPECT_EQ(rational_from_decimal(0.1), (Rational{1, 10}));
    EXPECT_EQ(rational_from_decimal(1e-4), (Rational{1, 10000}));
    EXPECT_EQ(rational_from_decimal(30), (Rational{30, 1}));
    EXPECT_FALSE(rational_from_decimal(1e-300));
}

TEST(Rational, MultipliesAndDividesExactlyOrNotAtAll) {
    EXPECT_EQ(product({1, 3}, {3, 7}), (Rational{1, 7}));
    EXPECT_EQ(quotient({1, 30000}, {1, 120}), (Rational{1, 250}));
    EXPECT_FALSE(quotient({1, 2}, {0, 1}));
    constexpr std::int64_t big = 3'000'000'000'000'000'019;
    EXPECT_FALSE(product({big, 1}, {big, 1}));
    EXPECT_EQ(product({big, 7}, {7, big}), (Rational{1, 1}));  // cancels before it overflows
}

}  // namespace doppel::rational_test

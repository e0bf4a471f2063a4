#include "numeric/roots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel::roots_test {

/// The coefficients of factor · Π (t − root) by powers of t.
std::vector<double> with_roots(const std::vector<double>& roots, double factor) {
    std::vector<double> a{factor};
    for (const double root : roots) {
        a.push_back(0);
        for (std::size_t i = a.size() - 1; i > 0; --i) a[i] = a[i - 1] - root * a[i];
        a[0] *= -root;
    }
    return a;
}

TEST(Bernstein, HasEndValuesAndBoundsOfThePolynomial) {
    const std::vector<double> a{0.3, -2, 1.5, 4, -3.3};
    const double length = 0.7;
    const auto polynomial = Bernstein::of_powers(a, length);
    const auto value = [&](double t) { return a[0] + t * (a[1] + t * (a[2] + t * (a[3] + t * a[4]))); };
    ASSERT_EQ(polynomial.b.size(), 5u);
    EXPECT_EQ(polynomial.b.front(), 0.3);
    EXPECT_NEAR(polynomial.b.back(), value(length), 1e-15);  // measured 0
    const auto [minimum, largest] = std::minmax_element(polynomial.b.begin(), polynomial.b.end());
    for (double t = 0; t <= length; t += 0.01) {
        EXPECT_GE(value(t), *minimum);
        EXPECT_LE(value(t), *largest);
    }
}

TEST(Bernstein, FindsEveryRiseInOrder) {
    const std::vector<double> roots{-0.5, 0.11, 0.112, 0.112001, 0.4, 0.9, 1.3};
    for (const double length : {1.0, 1.2, 0.2}) {
        // seven factors: below the first root the product is < 0, so it increases at the first, third … root
        const auto rises = Bernstein::of_powers(with_roots(roots, 2), length).rises();
        std::vector<double> expected;
        for (std::size_t i = 0; i < roots.size(); i += 2)
            if (roots[i] > 0 && roots[i] <= length) expected.push_back(roots[i]);
        ASSERT_EQ(rises.size(), expected.size()) << length;
        for (std::size_t i = 0; i < rises.size(); ++i) {
            EXPECT_LE(rises[i].low, expected[i]) << length;
            EXPECT_GE(rises[i].high, expected[i]) << length;
        }
    }
}

TEST(Bernstein, SeparatesPairsOfRootsDownToRounding) {
    for (const double apart : {1e-2, 1e-5, 1e-7}) {
        const auto rises = Bernstein::of_powers(with_roots({0.3 - apart / 2, 0.3 + apart / 2}, 1), 1).rises();
        ASSERT_EQ(rises.size(), 1u) << apart;
        EXPECT_GT(rises[0].low, 0.3 - apart / 2);  // only the second of the two roots is in the interval
        EXPECT_LT(rises[0].low, 0.3 + apart / 2);
        EXPECT_GT(rises[0].high, 0.3 + apart / 2);
    }
    EXPECT_TRUE(Bernstein::of_powers(std::vector<double>{0.09 + 1e-9, -0.6, 1}, 1).rises().empty());  // no root
}

TEST(Bernstein, CountsARootAtTheEndAndNoneAtTheStart) {
    EXPECT_EQ(Bernstein::of_powers(std::vector<double>{-1, 1}, 1).rises().size(), 1u);
    EXPECT_TRUE(Bernstein::of_powers(std::vector<double>{0, 1}, 1).rises().empty());
    EXPECT_TRUE(Bernstein::of_powers(std::vector<double>{1, -1}, 1).rises().empty());  // decreases
}

TEST(Bernstein, RisesThroughALevel) {
    const auto line = Bernstein::of_powers(std::vector<double>{0, 1}, 4);
    EXPECT_TRUE(line.rises(5).empty());
    const auto rises = line.rises(2.9);
    ASSERT_EQ(rises.size(), 1u);
    EXPECT_LT(rises[0].low, 2.9);
    EXPECT_GT(rises[0].high, 2.9);
}

TEST(Root, IsFoundWithinTheBracketWhereverNewtonsMethodWouldGo) {
    struct Now {
        double value, rate;
    };
    const auto flat = [](double t) { return Now{std::cbrt(t - 1), std::pow(std::cbrt(t - 1), -2) / 3}; };
    EXPECT_NEAR(root({0, 3}, flat), 1, 1e-15);
    const auto cosine = [](double t) { return Now{-std::cos(t), std::sin(t)}; };
    for (const double widest : {3.0, 0.1}) EXPECT_NEAR(root({0, 3}, cosine, widest), std::acos(0.0), 2e-16);
    EXPECT_EQ(root({-1, 1}, [](double t) { return Now{t, 1}; }), 0);
}

}  // namespace doppel::roots_test

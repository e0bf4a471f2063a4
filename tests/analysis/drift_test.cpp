#include "analysis/drift.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::drift_test {

TEST(Growth, IsClassifiedByItsExponent) {
    std::vector<double> times, errors;
    for (int i = 0; i <= 40; ++i) times.push_back(std::pow(10, 0.1 * i));
    using Kind = Growth::Kind;
    for (const auto& [power, expected] :
         {std::pair{0.0, Kind::bounded}, {0.5, Kind::root}, {1.0, Kind::linear}, {2.0, Kind::steeper}}) {
        errors.clear();
        // another power law before the last two decades has no effect
        for (const double t : times) errors.push_back(t < 99 ? 7 : std::pow(t, power));
        const auto growth = growth_of(times, errors, std::nan(""));
        EXPECT_NEAR(growth.exponent, power, 2e-15);  // measured 0
        EXPECT_EQ(growth.kind, expected);
    }
    EXPECT_EQ(growth_of(times, std::vector(times.size(), 0.0), std::nan("")).kind, Kind::bounded);
    // growth that begins in the last decade follows no law
    auto late = errors;
    for (std::size_t i = 0; i < late.size(); ++i) late[i] = std::fmax(late[i], errors[34]);
    EXPECT_EQ(growth_of(times, late, std::nan("")).kind, Kind::unsteady);
    // the maximum to date rises while the motion first visits the places with the largest errors, and is flat from then on
    for (auto& error : errors) error = std::fmin(error, errors[25]);
    EXPECT_GT(growth_of(times, errors, std::nan("")).exponent, 0.25);
    EXPECT_EQ(growth_of(times, errors, std::nan("")).kind, Kind::bounded);
    EXPECT_EQ(growth_of(times, errors, 65).kind, Kind::failed);
}

}  // namespace doppel::drift_test

#include "integrate/turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::turns_test {

/// Two rods of lengths 1 and 0.5 m at these angles, rad, and rates, rad/s.
Pendulum<double> chain(double first, double second, double rate1 = 0, double rate2 = 0) {
    return {{1, 1}, {1, 0.5}, {first, second}, {rate1, rate2}, 9.8};
}

State<double, 8> places(double first, double second, double rate1 = 0, double rate2 = 0) {
    return released_as_particles<double, 2>(chain(first, second, rate1, rate2));
}

/// The angles of Turns from positions.
Bobs<double> seen(const Turns& turns, const State<double, 8>& y) {
    auto bobs = bobs_of_particles(chain(0, 0), y);
    turns.add_to(bobs);
    return bobs;
}

/// Expects that Turns follows a motion; `at` gives both angles and rates at a time. Updates are `interval` apart, or, if
/// it is 0, as far apart as is allowed.
template <class At>
void expect_followed(const At& at, int updates, double interval, double within) {
    const auto places_at = [&](double t) { return std::apply(places, at(t)); };
    Turns turns({at(0)[0], at(0)[1]});
    turns.update(places_at(0), 0);
    double t = 0;
    for (int n = 1; n <= updates; ++n) {
        const double wait = interval > 0 ? interval : turns.longest_interval();
        const auto y = places_at(t += wait);
        turns.update(y, wait);
        for (const std::size_t rod : {0, 1}) ASSERT_NEAR(seen(turns, y)[rod].theta, at(t)[rod], within) << n;
    }
}

TEST(Turns, AreCountedBothWaysFromAnyStart) {
    // one rod rotates ever faster, up to 0.4 turns per sample; the other oscillates over the top, some turns ahead
    expect_followed(
        [](double n) {
            return std::array{7.5 - 1.2e-3 * n * n, -20 + 9 * std::sin(0.25 * n), 0.0, 0.0};
        },
        1000, 1, 2e-12);  // measured 2e-13
}

TEST(Turns, AreKeptWhereARodPointsStraightUp) {
    // there the angle is π or −π, by the sign of a zero; positions may give either one
    for (const double released : {pi, -pi, 3 * pi, -3 * pi})
        for (const double x : {0.0, -0.0, 1e-20, -1e-20}) {
            Turns turns({released, released});
            auto y = places(released, released);
            y[0] = x;
            y[2] = 2 * x;
            turns.update(y, 0);
            for (const auto& bob : seen(turns, y)) EXPECT_DOUBLE_EQ(bob.theta, released) << x;
        }
}

TEST(Turns, AreNotAddedWhereNotFollowed) {
    Turns turns;
    EXPECT_FALSE(turns.followed());
    turns.update(places(4, 5), 0);
    EXPECT_DOUBLE_EQ(seen(turns, places(4, 5))[0].theta, 4 - 2 * pi);
}

TEST(Turns, AreCountedForMoreThanHalfATurnBetweenUpdates) {
    // 30 rad and −20 rad per sample; the first rate doubles, the second falls to zero
    const auto at = [](double n) {
        return std::array{15 * n + 0.15 * n * n, 3 - 20 * n + 0.2 * n * n, 15 + 0.3 * n, -20 + 0.4 * n};
    };
    expect_followed(at, 50, 1, 1e-11);  // measured 4e-13
}

TEST(Turns, AreNotCountedForARodThatSwingsToAndFro) {
    // by 0.9 rad about the top, like a light mass between heavy ones; up to 8 rad of motion between two samples
    const auto at = [](double t) {
        return std::array{pi + 0.9 * std::sin(4000 * t), 0.0, 0.9 * 4000 * std::cos(4000 * t), 0.0};
    };
    expect_followed(at, 100'000, 0, 1e-12);  // measured 9e-16
}

TEST(Turns, AreUpdatedMoreOftenForFasterRods) {
    Turns turns({0, 0});
    turns.update(places(0, 0, 3, -8), 0);
    EXPECT_DOUBLE_EQ(turns.longest_interval(), Turns::longest);
    turns.update(places(0, 0, 2000, -8), 0);
    EXPECT_DOUBLE_EQ(turns.longest_interval(), Turns::largest_turn / 2000);
}

}  // namespace doppel::turns_test

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

TEST(Turns, AreCountedBothWaysFromAnyStart) {
    // one rod rotates ever faster, up to 0.4 turns per sample; the other oscillates over the top, some turns ahead
    const auto first = [](int n) { return 7.5 - 1.2e-3 * n * n; };
    const auto second = [](int n) { return -20 + 9 * std::sin(0.25 * n); };
    Turns turns({first(0), second(0)});
    turns.update(places(first(0), second(0)), 0);
    for (int n = 0; n <= 1000; ++n) {
        const auto y = places(first(n), second(n));
        turns.update(y, 1);
        const auto bobs = seen(turns, y);
        ASSERT_NEAR(bobs[0].theta, first(n), 2e-12) << n;   // measured 2e-13
        ASSERT_NEAR(bobs[1].theta, second(n), 1e-14) << n;  // measured 2e-15
    }
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
    const auto first = [](double n) { return 15 * n + 0.15 * n * n; };
    const auto second = [](double n) { return 3 - 20 * n + 0.2 * n * n; };
    const auto at = [&](double n) { return places(first(n), second(n), 15 + 0.3 * n, -20 + 0.4 * n); };
    Turns turns({first(0), second(0)});
    turns.update(at(0), 0);
    for (int n = 1; n <= 50; ++n) {
        turns.update(at(n), 1);
        const auto bobs = seen(turns, at(n));
        ASSERT_NEAR(bobs[0].theta, first(n), 1e-11) << n;   // measured 4e-13
        ASSERT_NEAR(bobs[1].theta, second(n), 1e-11) << n;  // measured 3e-13
    }
}

TEST(Turns, AreNotCountedForARodThatSwingsToAndFro) {
    // by 0.9 rad about the top, like a light mass between heavy ones; up to 8 rad of motion between two samples
    const auto angle = [](double t) { return pi + 0.9 * std::sin(4000 * t); };
    const auto rate = [](double t) { return 0.9 * 4000 * std::cos(4000 * t); };
    Turns turns({angle(0), 0});
    turns.update(places(angle(0), 0, rate(0)), 0);
    double t = 0;
    for (int n = 1; n <= 100'000; ++n) {
        const double wait = turns.longest_interval();
        t += wait;
        const auto y = places(angle(t), 0, rate(t));
        turns.update(y, wait);
        ASSERT_NEAR(seen(turns, y)[0].theta, angle(t), 1e-12) << n;  // measured 9e-16
    }
}

TEST(Turns, AreUpdatedMoreOftenForFasterRods) {
    Turns turns({0, 0});
    turns.update(places(0, 0, 3, -8), 0);
    EXPECT_DOUBLE_EQ(turns.longest_interval(), Turns::longest);
    turns.update(places(0, 0, 2000, -8), 0);
    EXPECT_DOUBLE_EQ(turns.longest_interval(), Turns::largest_turn / 2000);
}

}  // namespace doppel::turns_test

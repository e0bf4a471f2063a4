#include "integrate/turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace {

/// Two rods of lengths 1 and 0.5 m at these angles, rad.
Pendulum<double> chain(double first, double second) {
    return {{1, 1}, {1, 0.5}, {first, second}, {0, 0}, 9.8};
}

State<double, 8> places(double first, double second) {
    return released_as_particles<double, 2>(chain(first, second));
}

/// The angles that turns make of what places tell.
Bobs<double> seen(const Turns& turns, const State<double, 8>& y) {
    auto bobs = bobs_of_particles(chain(0, 0), y);
    turns.add_to(bobs);
    return bobs;
}

TEST(Turns, AreCountedBothWaysFromAnyStart) {
    // one rod goes round ever faster, up to 0.4 turns a look, the other to and fro over the top, from some turns ahead
    const auto first = [](int n) { return 7.5 - 1.2e-3 * n * n; };
    const auto second = [](int n) { return -20 + 9 * std::sin(0.25 * n); };
    Turns turns({first(0), second(0)});
    turns.look(places(first(0), second(0)));
    for (int n = 0; n <= 1000; ++n) {
        const auto y = places(first(n), second(n));
        turns.look(y);
        const auto bobs = seen(turns, y);
        ASSERT_NEAR(bobs[0].theta, first(n), 2e-12) << n;   // measured 2e-13
        ASSERT_NEAR(bobs[1].theta, second(n), 1e-14) << n;  // measured 2e-15
    }
}

TEST(Turns, AreKeptWhereARodPointsStraightUp) {
    // there the angle is π or −π by the sign of a zero; places may give either for what was released as the other
    for (const double released : {pi, -pi, 3 * pi, -3 * pi})
        for (const double x : {0.0, -0.0, 1e-20, -1e-20}) {
            Turns turns({released, released});
            auto y = places(released, released);
            y[0] = x;
            y[2] = 2 * x;
            turns.look(y);
            for (const auto& bob : seen(turns, y)) EXPECT_DOUBLE_EQ(bob.theta, released) << x;
        }
}

TEST(Turns, AreNotAddedWhereNotFollowed) {
    Turns turns;
    EXPECT_FALSE(turns.followed());
    turns.look(places(4, 5));
    EXPECT_DOUBLE_EQ(seen(turns, places(4, 5))[0].theta, 4 - 2 * pi);
}

}  // namespace
}  // namespace doppel

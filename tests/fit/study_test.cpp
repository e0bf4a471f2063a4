#include "base/error.hpp"
#include "fit/result.hpp"
#include "fit/support.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>

namespace doppel {
namespace study_test {

using namespace test;

/// A pendulum of two bodies of any make.
FittedPendulum any_pendulum(std::mt19937_64& random) {
    std::uniform_real_distribution<double> even;
    const auto between = [&](double low, double high) { return low + (high - low) * even(random); };
    FittedPendulum made{.gravity = 9.8};
    made.mass = {0.4 * std::pow(6.0, even(random)), 1};
    for (std::size_t k = 0; k < 2; ++k) {
        made.length[k] = between(0.15, 0.5);
        made.center[k] = made.length[k] * between(0.35, 0.75);
        made.inertia[k] = made.mass[k] * std::pow(made.length[k], 2) / 12 * between(0.7, 1.4);
    }
    return made;
}

/// 8 to 30 s of it at 100 to 500 Hz with 0.5 mrad of noise: weakly damped, mostly over the top.
Track energetic_track(unsigned seed) {
    std::mt19937_64 random(seed);
    auto p = ratios_of(any_pendulum(random));
    std::uniform_real_distribution<double> even;
    for (const auto parameter : {viscous_1, viscous_2}) at(p, parameter) = 0.002 * std::pow(50.0, even(random));
    const bool has_drag = even(random) < 0.35;
    for (const auto parameter : {quadratic_1, quadratic_2})
        at(p, parameter) = has_drag ? 0.001 * std::pow(10.0, even(random)) : 0;
    constexpr std::array rates{100.0, 200.0, 250.0, 500.0};
    return simulated(p, even(random) < 0.5 ? Drag::own : Drag::carried,
                     {.pieces = 1,
                      .piece_s = 8 + 22 * even(random),
                      .hz = rates[static_cast<std::size_t>(4 * even(random))],
                      .noise = 5e-4,
                      .amplitude = even(random) < 0.6 ? 3.1 : 1.5,
                      .seed = seed});
}

// Of 200 of these tracks 15 were once refused or fitted to a wrong motion: over stretches too long for their chaos, from starts that
// the model before had spoilt. The suite has some of these; DOPPEL_LONG_FIT=1 runs all, in some four minutes.
TEST(FitStudy, EnergeticTracksAreFittedToTheirNoise) {
    std::vector<unsigned> seeds{16, 80, 86, 122, 191};
    if (std::getenv("DOPPEL_LONG_FIT")) {
        seeds.resize(200);
        std::iota(seeds.begin(), seeds.end(), 1u);
    }
    int fitted = 0;
    for (const auto seed : seeds) {
        const auto track = energetic_track(seed);
        try {
            const auto result = answer(track, {}, 2, no_stop, [](std::size_t, std::size_t) {});
            EXPECT_LT(result.chosen().fit.rms, 5.3e-4)
                << seed << ": " << result.chosen().name;  // measured 4.8 to 5.1e-4
            ++fitted;
        } catch (const Error& error) {
            ADD_FAILURE() << seed << ": " << error.what();
        }
    }
    EXPECT_EQ(fitted, static_cast<int>(seeds.size()));
}

}  // namespace study_test
}  // namespace doppel

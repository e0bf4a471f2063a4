#include "analysis/stability.hpp"

#include "integrate/motion.hpp"
#include "physics/bob.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

namespace doppel::stability_test {

Pendulum<double> chain(std::vector<double> mass, std::vector<double> angle) {
    Pendulum<double> p{.mass = mass, .length = std::vector(mass.size(), 1.0), .angle = angle};
    p.rate.assign(mass.size(), 0);
    return p;
}

/// The ratio of the energy above hanging after `steps` steps of the method to that at the start: a single link of ω = 1
/// rad/s at a small angle.
double energy_left(const char* method, double z, long steps) {
    const bool rods = std::string_view(method).starts_with("rattle");
    constexpr double amplitude = 1e-10;  // small even after growth by a factor of a million
    const Pendulum<Quad> link{.mass = {1}, .length = {1}, .angle = {Quad(amplitude)}, .rate = {0}, .gravity = 1};
    const auto motion = make_motion({.chain = link,
                                     .parts = {},
                                     .model = rods ? Model::constraints : Model::angles,
                                     .method = method,
                                     .precision = Precision::in_quad,
                                     .sample_interval = *rational_from_decimal(z * static_cast<double>(steps)),
                                     .steps_per_sample = steps});
    const std::atomic<bool> never = false;
    motion->advance(never);
    return 1 + motion->observe().energy_change / (amplitude * amplitude / 2);
}

TEST(EnergyGrowth, IsThatOfOneStepInClosedForm) {
    for (const double z : {0.01, 0.3, 1.0, 1.7}) {
        EXPECT_DOUBLE_EQ(energy_growth("euler", z, 1), 1 + z * z);
        EXPECT_DOUBLE_EQ(energy_growth("midpoint", z, 1), 1 + std::pow(z, 4) / 4);
        EXPECT_NEAR(energy_growth("rk4", z, 1), 1 - std::pow(z, 6) / 72 + std::pow(z, 8) / 576, 2e-15);
        for (const auto* method : {"semi-implicit-euler", "rattle", "rattle6", "gauss4", "gauss6"})
            EXPECT_EQ(energy_growth(method, z, 1000), 1) << method;
    }
    // the trace of a leapfrog is 2 − z²
    for (const auto* method : {"semi-implicit-euler", "rattle"}) {
        const double now = std::sqrt(energy_growth(method, 2.5, 1));
        EXPECT_NEAR(now + 1 / now, 2.5 * 2.5 - 2, 3e-15) << method;  // measured 0
    }
    EXPECT_EQ(energy_growth("gauss6", 100, 1000), 1);
}

TEST(EnergyGrowth, IsThatOfTheSteppers) {
    // where only the growing root remains; measured 7e-16, 1.3e-14, 9.1e-14
    for (const auto& [method, z, steps, maximum] :
         {std::tuple{"euler", 0.3, 20L, 5e-15}, {"midpoint", 0.5, 20L, 7e-14}, {"rk4", 1.5, 20L, 5e-13}})
        EXPECT_NEAR(energy_left(method, z, steps) / energy_growth(method, z, steps), 1, maximum) << method;
    // measured 6e-11, 3.1e-8, 7.5e-5, 1.1e-8
    for (const auto& [method, z, steps, maximum] : {std::tuple{"semi-implicit-euler", 2.5, 8L, 3e-10},
                                                    {"rattle", 2.5, 6L, 2e-7},
                                                    {"rattle6", 2.7, 10L, 5e-4},
                                                    {"rattle6", 3.6, 5L, 7e-8}}) {
        const double ratio = energy_left(method, z, steps + 1) / energy_left(method, z, steps);
        EXPECT_NEAR(ratio / energy_growth(method, z, 1), 1, maximum) << method << " " << z;
    }
    for (const auto& [method, z] : {std::pair{"rattle6", 2.5}, {"rattle6", 3.1}, {"gauss4", 1.5}, {"rattle", 1.9}})
        EXPECT_LT(energy_left(method, z, 200), 30) << method << " " << z;  // measured 11 at most
}

TEST(EnergyGrowth, OfAdamsBeginsAtTheDocumentedLimit) {
    double stable = 0.1, unstable = 1;
    while (unstable - stable > 1e-6) {
        const double middle = (stable + unstable) / 2;
        (energy_growth("adams", middle, 100'000) < 2 ? stable : unstable) = middle;
    }
    std::ifstream page(DOPPEL_SOURCE_DIR "/docs/methods.md");
    const std::string text(std::istreambuf_iterator<char>(page), {});
    EXPECT_NE(text.find(fmt::format("2.83/ω, 2/ω and {:.3f}/ω", stable)), std::string::npos) << stable;
}

TEST(SmallOscillations, AreTheRootsOfLaguerre) {
    // L2: 2 ∓ √2; L3: x³ − 9x² + 18x − 6
    const auto two = small_oscillations(chain({1, 1}, {0.1, 0}));
    ASSERT_EQ(two.size(), 2u);
    EXPECT_NEAR(two[0].frequency, std::sqrt(9.8 * (2 - std::sqrt(2.0))), 3e-15);  // measured 4.4e-16
    EXPECT_NEAR(two[1].frequency, 5.7844, 5e-5);
    EXPECT_NEAR(two[0].share, 0.5, 2e-15);  // measured 3.3e-16
    EXPECT_NEAR(two[1].share, 0.5, 3e-15);  // measured 4.4e-16
    for (const auto& mode : small_oscillations(chain({1, 1, 1}, {0, 0, 0}))) {
        const double x = mode.frequency * mode.frequency / 9.8;
        EXPECT_NEAR(x * (x * (x - 9) + 18) - 6, 0, 5e-14);  // measured 7e-15
    }
}

TEST(SmallOscillations, OfTwoMassesAreInClosedForm) {
    // with μ = m2/m1: ω² = g/l (1 + μ) (1 ± √(μ / (1 + μ)))
    for (const double ratio : {0.01, 0.3, 1.0, 10.0}) {
        const double mu = 1 / ratio;
        EXPECT_NEAR(small_oscillations(chain({ratio, 1}, {0, 0})).back().frequency /
                        std::sqrt(9.8 * (1 + mu) * (1 + std::sqrt(mu / (1 + mu)))),
                    1, 1e-13)
            << ratio;
    }
}

TEST(SmallOscillations, ShareTheEnergyOfTheRelease) {
    // released in one of the modes: θ2 = ∓√2 θ1
    EXPECT_NEAR(small_oscillations(chain({1, 1}, {0.1, -0.1 * std::sqrt(2.0)}))[1].share, 1, 5e-16);  // measured 0
    EXPECT_NEAR(small_oscillations(chain({1, 1}, {0.1, 0.1 * std::sqrt(2.0)}))[1].share, 0, 2e-30);   // measured 2e-31
    auto pushed = chain({1, 1}, {0, 0});
    EXPECT_EQ(small_oscillations(pushed)[1].share, 1);  // without energy, the fastest mode has all of it
    pushed.rate = {1, std::sqrt(2.0)};
    EXPECT_NEAR(small_oscillations(pushed)[0].share, 1, 5e-16);  // measured 0
}

TEST(StepLimit, OfAVeryLongTimeIsThatOfStability) {
    const std::vector<Mode> fast{{.frequency = 5.0}};
    constexpr double long_time = 1e5;
    for (const auto& [method, z] :
         {std::pair{"semi-implicit-euler", 2.0}, {"rattle", 2.0}, {"rk4", 2 * std::sqrt(2.0)}, {"rattle6", 2.53263}})
        EXPECT_NEAR(5 * step_limit(method, fast, long_time, 10).value(), z, 2e-5) << method;  // measured 3e-6
    EXPECT_FALSE(step_limit("gauss6", fast, long_time, 10));
    EXPECT_FALSE(step_limit("rk4", fast, 0.4, 10));  // too short a time for any limit
}

TEST(StepLimit, OfEulerAndMidpointIsWhereTheyHaveGrown) {
    // (1 + z²)^(t/h) = 10 with z → 0: h = ln 10 / (ω² t); midpoint: h³ = 4 ln 10 / (ω⁴ t)
    const std::vector<Mode> mode{{.frequency = 2.0}};
    EXPECT_NEAR(step_limit("euler", mode, 1e4, 10).value() / (std::log(10.0) / 4e4), 1, 3e-6);  // measured 5e-7
    EXPECT_NEAR(step_limit("midpoint", mode, 1e4, 10).value() / std::cbrt(4 * std::log(10.0) / 16e4), 1,
                1e-5);  // measured 1e-6
}

TEST(StepLimit, DependsOnTheEnergyInEachMode) {
    const std::vector<Mode> half{{2.0, 0.5}, {5.0, 0.5}};
    const double limit = step_limit("euler", half, 100, 10).value();
    const double grown = 0.5 * std::pow(1 + 4 * limit * limit, std::lround(100 / limit)) +
                         0.5 * std::pow(1 + 25 * limit * limit, std::lround(100 / limit));
    EXPECT_NEAR(grown, 10, 7e-5);  // measured 1e-5
}

TEST(StepLimit, OfAFewStepsOfAdamsIsThatOfTheStepper) {
    const std::vector<Mode> alone{{.frequency = 1.0}};
    for (const double seconds : {15.0, 20.0, 30.0}) {
        const double limit = step_limit("adams", alone, seconds, 10).value();
        const long steps = std::lround(seconds / limit);                            // 21, 38, 73
        EXPECT_LT(energy_left("adams", (1 - 1e-5) * limit, steps), 10) << seconds;  // measured 9.997, 9.996, 9.993
        EXPECT_GT(energy_left("adams", (1 + 1e-5) * limit, steps), 10) << seconds;  // measured 10.003, 10.005, 10.008
    }
}

TEST(ReleasedEnergy, IsThatAboveHanging) {
    const Pendulum<double> p{.mass = {2, 3}, .length = {0.5, 0.7}, .angle = {0.4, 2.0}, .rate = {1.5, -0.3}};
    const double bottom = -p.potential_range() / 2;
    EXPECT_NEAR(released_energy(p),
                energy(bobs_of_angles(p, released_in_angles<double, Eigen::Dynamic>(p)), p.gravity) - bottom,
                5e-14);  // measured 7.1e-15
    // with θ = 10⁻⁷ the difference of the heights alone would have only two digits
    EXPECT_NEAR(released_energy({.angle = {1e-7, 0}}) / (0.5 * 9.8 * 2e-14), 1, 5e-15);  // measured 1e-15
}

TEST(GreatestEnergyErrors, AreThoseOfTheSamplesAndNaNForAFailedRun) {
    const std::atomic<bool> never = false;
    std::vector<Pendulum<Quad>> releases;
    for (int i = 1; i <= 11; ++i) releases.push_back({.angle = {Quad(i) / 4, 0}});
    int blown = 0;
    for (const auto model : {Model::angles, Model::constraints})
        for (const char* method : {"euler", "rk4", "adams"})
            for (const long steps : {1L, 32L}) {
                MotionSpec spec{.model = model, .method = method, .sample_interval = {1, 2}, .steps_per_sample = steps};
                const auto errors = max_energy_errors(spec, releases, 8, never);
                ASSERT_EQ(errors.size(), releases.size());
                for (std::size_t i = 0; i < releases.size(); ++i) {
                    spec.chain = releases[i];
                    const auto motion = make_motion(spec);
                    double maximum = 0;
                    for (int n = 0; n < 8; ++n) {
                        motion->advance(never);
                        const double error = std::abs(motion->observe().energy_change);
                        maximum = error <= maximum ? maximum : error;  // keeps NaN
                    }
                    maximum /= released_energy(releases[i].cast<double>());
                    EXPECT_TRUE(errors[i] == maximum || (std::isnan(errors[i]) && !(maximum <= failure_error)))
                        << method << ' ' << steps << ' ' << i << ' ' << errors[i] << ' ' << maximum;
                    blown += std::isnan(errors[i]);
                }
            }
    EXPECT_GT(blown, 10);
    // a method that fails
    const MotionSpec coarse{.method = "gauss4", .sample_interval = {3, 1}, .steps_per_sample = 1};
    EXPECT_TRUE(std::isnan(max_energy_errors(coarse, releases, 8, never).back()));
}

}  // namespace doppel::stability_test

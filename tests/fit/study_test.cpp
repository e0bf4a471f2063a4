#include "fit/support.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <numeric>

namespace doppel::study_test {

using namespace test;

/// A pendulum of two random rigid bodies.
PhysicalPendulum<double> any_pendulum(std::mt19937_64& random) {
    std::uniform_real_distribution<double> even;
    const auto between = [&](double low, double high) { return low + (high - low) * even(random); };
    PhysicalPendulum<double> made = point_masses(0.4 * std::pow(6.0, even(random)), 1, 1, 1);
    for (std::size_t k = 0; k < 2; ++k) {
        auto& length = made.chain.length[k];
        length = between(0.15, 0.5);
        made.center[k] = length * between(0.35, 0.75);
        made.inertia[k] = made.chain.mass[k] * std::pow(length, 2) / 12 * between(0.7, 1.4);
    }
    return made;
}

/// 8 to 30 s of it at 100 to 500 Hz with 0.5 mrad of noise: weakly damped, mostly with full turns.
Track energetic_track(unsigned seed) {
    std::mt19937_64 random(seed);
    auto p = ratios_of(any_pendulum(random));
    std::uniform_real_distribution<double> even;
    for (const auto parameter : {viscous_1, viscous_2}) p[parameter] = 0.002 * std::pow(50.0, even(random));
    const bool has_drag = even(random) < 0.35;
    for (const auto parameter : {quadratic_1, quadratic_2})
        p[parameter] = has_drag ? 0.001 * std::pow(10.0, even(random)) : 0;
    constexpr std::array rates{100.0, 200.0, 250.0, 500.0};
    return simulated(p, even(random) < 0.5 ? Drag::own : Drag::carried,
                     {.pieces = 1,
                      .piece_s = 8 + 22 * even(random),
                      .hz = rates[static_cast<std::size_t>(4 * even(random))],
                      .noise = 5e-4,
                      .amplitude = even(random) < 0.6 ? 3.1 : 1.5,
                      .seed = seed});
}

/// All seeds up to `all` with DOPPEL_LONG_FIT=1, otherwise `some`.
std::vector<unsigned> seeds_of(unsigned all, std::vector<unsigned> some) {
    if (!std::getenv("DOPPEL_LONG_FIT")) return some;
    some.resize(all);
    std::iota(some.begin(), some.end(), 1u);
    return some;
}

// 15 of 200 such tracks once failed or gave a wrong motion: the stretches were too long for their chaos, and the starts
// came from a wrong earlier model. The suite has some of these; DOPPEL_LONG_FIT=1 runs all, in about two
// minutes.
TEST(FitStudy, EnergeticTracksAreFittedToTheirNoise) {
    for (const auto seed : seeds_of(200, {16, 80, 86, 122, 191})) try {
            const auto result = answered(energetic_track(seed));
            EXPECT_LT(result.chosen().fit.rms, 5.3e-4)
                << seed << ": " << result.chosen().name;  // measured 4.8 to 5.1e-4
        } catch (const Error& error) {
            ADD_FAILURE() << seed << ": " << error.what();
        }
}

/// 8 to 20 s with Coulomb friction as in "simulate", 0.5 mrad of noise; `truth` receives the true parameters.
Track rubbing_track(unsigned seed, Parameters& truth) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> even;
    std::normal_distribution<double> normal;
    auto made = any_pendulum(random);
    const double b = made.inertia[1] + made.chain.mass[1] * made.center[1] * made.center[1];
    for (std::size_t k = 0; k < 2; ++k) {
        made.friction.viscous.push_back(b * 0.005 * std::pow(10.0, even(random)));
        made.friction.coulomb.push_back(b * 0.03 * std::pow(5.0, even(random)));
    }
    truth = ratios_of(made);
    const double seconds = 8 + 12 * even(random);
    const long hz = std::array{200, 250, 500}[static_cast<std::size_t>(3 * even(random))];
    const auto samples = static_cast<std::size_t>(seconds * static_cast<double>(hz));
    const auto within = [&](double size) { return size * (2 * even(random) - 1); };
    const LinkState start{within(1.5), within(1.5), within(4), within(4)};
    const auto angles = simulated_angles(made, start, hz, samples);
    Track track{.pieces = {{.name = "simulated.csv"}}, .start_s = {0}, .noise = {5e-4, 5e-4}};
    auto& piece = track.pieces[0];
    for (std::size_t i = 0; i < samples; ++i) {
        piece.time_s.push_back(static_cast<double>(i) / static_cast<double>(hz));
        for (std::size_t arm = 0; arm < 2; ++arm) piece.angle[arm].push_back(angles[i][arm] + 5e-4 * normal(random));
    }
    for (auto& outliers : piece.is_outlier) outliers.assign(samples, 0);
    return track;
}

// With a law that is smooth within 5 deg/s, 86 % of the intervals contained this friction; the worst was 8 standard
// errors off. The suite has some of these tracks. DOPPEL_LONG_FIT=1 runs 60, in a minute.
TEST(FitStudy, IntervalsHoldCoulombFriction) {
    int within = 0, count = 0;
    double worst = 0;
    for (const auto seed : seeds_of(60, {31, 45, 58, 1})) {
        Parameters truth;
        const auto result = answered(rubbing_track(seed, truth));
        for (const auto k : result.chosen().fit.model.list()) {
            if (!is_friction(k)) continue;
            const double off =
                std::abs(result.chosen().fit.parameters[k] - truth[k]) / result.uncertainty.standard_error(k);
            within += off < 1.96, ++count;
            worst = std::max(worst, off);
        }
    }
    EXPECT_GT(within / static_cast<double>(count), count > 100 ? 0.93 : 0.8);  // measured 0.971 of 240
    EXPECT_LT(worst, 3.5);                                                     // measured 2.4
    RecordProperty("worst", std::to_string(worst));
}

/// How often the true values lie within ± 1.96 standard errors, for all parameters together ("") and for each; and
/// how often the residuals look like noise ("white").
std::map<std::string_view, double> coverage_of(int trials, const Parameters& truth, const ModelSpec& model,
                                               double noise) {
    std::map<std::string_view, double> shares;
    const auto parameters = model.list();
    for (int trial = 0; trial < trials; ++trial) {
        const auto track = simulated(truth, model.drag, {.noise = noise, .seed = static_cast<unsigned>(1000 + trial)});
        const auto fit = fitted(model, truth, track);
        const auto uncertainty = uncertainty_of({track, no_stop, 2}, fit);
        shares["white"] += uncertainty.is_white / static_cast<double>(trials);
        for (const auto k : parameters) {
            const bool is_within = std::abs(fit.parameters[k] - truth[k]) < 1.96 * uncertainty.standard_error(k);
            shares[parameter_words[k].key] += is_within / static_cast<double>(trials);
            shares[""] += is_within / static_cast<double>(trials * parameters.size());
        }
    }
    return shares;
}

// All trials share their parameters: 200 of them determine a share of 95 % to 1.5 % for one parameter.
// DOPPEL_LONG_FIT=1 runs 1000.
TEST(FitCoverage, NineteenOfTwentyIntervalsContainTheTruth) {
    auto truth = lab_arms();
    truth[coulomb_1] = truth[coulomb_2] = truth[quadratic_1] = truth[quadratic_2] = 0;
    truth[offset_1] = 0.002, truth[offset_2] = -0.001;
    auto shares = coverage_of(std::getenv("DOPPEL_LONG_FIT") ? 1000 : 200, truth, model_of(false, 1), 1e-3);
    EXPECT_NEAR(shares[""], 0.95, 0.02);  // measured 0.945
    EXPECT_GT(shares["white"], 0.99);     // 197 of 200 if what fitting adds counts
    shares.erase("white");
    for (const auto& [key, share] : shares) EXPECT_NEAR(share, 0.945, 0.045) << key;  // measured 0.92 to 0.96
}

// Three kinds of friction are hard to distinguish: the intervals are wide, but correct. DOPPEL_LONG_FIT=1: 200 trials.
TEST(FitCoverage, IsRightForEveryKindOfFriction) {
    const bool is_long = std::getenv("DOPPEL_LONG_FIT");
    const double share = coverage_of(is_long ? 200 : 25, lab_arms(), model_of(false, 3, Drag::carried), 3e-4)[""];
    EXPECT_GT(share, is_long ? 0.93 : 0.88);  // measured 0.942 of 200 trials
    EXPECT_LT(share, is_long ? 0.97 : 1.0);
}

}  // namespace doppel::study_test

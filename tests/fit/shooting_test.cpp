#include "fit/report.hpp"
#include "fit/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace doppel::shooting_test {

using namespace test;

TEST(FitShooting, DerivativesAreThoseOfDifferences) {
    auto truth = lab_arms();
    truth[lag] = 0.001, truth[scale_1] = 1.01, truth[offset_1] = 0.01;
    truth[coulomb_1] = truth[coulomb_2] = 2;
    for (const bool point : {true, false}) {
        const auto drag = point ? Drag::own : Drag::carried;
        const auto track = simulated(truth, drag, {.pieces = 1, .piece_s = 1});
        auto fit = fit_at(model_of(point, 3, drag, 2), truth, track);
        fit.step_s = 0.004, fit.scale = {1e6, 1e6};  // all residuals are in the quadratic range
        fit.shots = {{.last = track.samples(), .start = fit.shots[0].start + LinkState(0.01, 0, 1, -1)}};
        auto& p = fit.parameters;
        const auto sums_here = [&] {
            evaluate_fit({track, no_stop}, fit);
            return fit.shots[0].sums;
        };
        const auto sums = sums_here();
        const auto check = [&](double& value, double slope, std::string_view what) {
            const double h = 1e-5 * std::max(std::abs(value), 0.1), was = value;
            const auto cost_at = [&](double shift) {
                value = was + shift;
                return sums_here().cost;
            };
            const double difference = (cost_at(h) - cost_at(-h)) / (2 * h);
            cost_at(0);
            EXPECT_NEAR(-difference, slope, 1e-6 * std::abs(slope) + 1e-15) << what;  // measured 1e-7
        };
        for (Eigen::Index q = 0; q < 4; ++q) check(fit.shots[0].start[q], sums.normal(4, q), "start");
        for (const auto k : fit.model.list()) check(p[k], sums.normal(4, 5 + k), parameter_words[k].key);
    }
}

TEST(FitShooting, FindsANoiselessTruth) {
    auto truth = lab_arms();
    truth[coulomb_1] = truth[coulomb_2] = 0;
    truth[offset_1] = 0.003, truth[offset_2] = -0.002;
    const auto track = simulated(truth, Drag::carried, {.hz = 200});
    auto model = model_of(false, 1, Drag::carried);
    model.fitted[quadratic_1] = model.fitted[quadratic_2] = true;
    auto wrong = truth;
    for (const auto k : model.list()) wrong[k] *= 1.05;
    const auto fit = fitted(model, wrong, track, {.max_passes = 60, .relative = 1e-12});
    for (const auto k : model.list())  // measured 3e-8
        EXPECT_NEAR(fit.parameters[k], truth[k], 1e-6 * std::max(std::abs(truth[k]), 0.1)) << parameter_words[k].key;
    EXPECT_LT(fit.rms, 1e-8);
}

TEST(FitShooting, KeepsFrictionFromBeingNegative) {
    auto truth = lab_arms(false);
    truth[viscous_1] = -0.05, truth[viscous_2] = 0.02;
    const auto fit = fitted(model_of(false, 1), lab_arms(false), simulated(truth, Drag::own, {.noise = 1e-3}));
    EXPECT_EQ(fit.parameters[viscous_1], 0);
    EXPECT_TRUE(fit.is_at_bound(viscous_1));
    EXPECT_FALSE(fit.is_at_bound(viscous_2));
}

/// One angle in a hundred is random.
TEST(FitShooting, IsRobustAgainstOutliers) {
    auto track = simulated(lab_arms(false), Drag::own, {.noise = 1e-3});
    for (auto& piece : track.pieces)
        for (std::size_t i = 7; i < piece.size(); i += 100) piece.angle[i % 2][i] += 0.5;
    const auto fit = fitted(model_of(false, 0), lab_arms(false), track);
    EXPECT_NEAR(fit.parameters[inertia], 1.8, 0.004);  // measured 0.0009; least squares: 0.08
    EXPECT_NEAR(fit.parameters[gravity_2], 50, 0.05);  // measured 0.01
}

/// The start of a motion that diverges is guessed again, and the fit continues.
TEST(FitShooting, ContinuesAfterOneBadStart) {
    const auto track = simulated(lab_arms(false), Drag::own, {.pieces = 3, .noise = 1e-3});
    auto start = fit_at(model_of(false, 0), lab_arms(false), track);
    start.shots[1].start[2] = 2e4;                                         // rad/s
    EXPECT_NEAR(fit_model({track, no_stop}, start, {})->rms, 1e-3, 5e-5);  // measured 1.00e-3: the noise
}

TEST(FitShooting, EndsSoonAfterItIsStopped) {
    const auto track = simulated(lab_arms(false), Drag::own, {.pieces = 3, .noise = 1e-3});
    auto fit = fit_at(model_of(false, 0), lab_arms(false), track);
    const std::atomic<bool> stop = true;
    EXPECT_THROW(evaluate_fit({track, stop}, fit), Error);
    EXPECT_EQ(fit.shots[0].sums.count, 0);
    EXPECT_THROW(tracks_of_texts({"a.csv"}, {csv_of(track.pieces[0])}, stop), Error);
}

/// Sums that are not finite, as of a motion that almost diverged, once caused an infinite loop.
TEST(FitHierarchy, LeavingOutEndsWhereSumsAreNotFinite) {
    const auto track = simulated(lab_arms(), Drag::own, {.noise = 1e-3});
    auto fit = fit_at(model_of(false, 2), lab_arms(), track);
    evaluate_fit({track, no_stop}, fit);
    fit.shots[0].sums.normal(5, 5) = -std::numeric_limits<double>::infinity();
    const auto without = stepped(fit, 0, 2, 2);
    EXPECT_FALSE(std::isfinite(without.parameters[inertia]));
}

/// Leaving out a parameter in one step gives almost the same result as a fit without it.
TEST(FitHierarchy, LeavesOutAsAFitWithoutWould) {
    const auto track = simulated(lab_arms(), Drag::own, {.noise = 1e-3});
    const auto all = fitted(model_of(false, 1), lab_arms(), track);
    const auto quick = stepped(all, 0, 2, 2);
    auto rest = all;
    rest.is_evaluated = false;
    std::erase_if(rest.shots, [](const Shot& shot) { return shot.unit == 2; });
    const auto exact = *fit_model({track, no_stop}, rest, {.finds_scale = false, .step_share = 0});
    for (const auto k : all.model.list()) {
        const double moved = std::abs(exact.parameters[k] - all.parameters[k]);
        EXPECT_NEAR(quick.parameters[k], exact.parameters[k], 0.1 * moved + 1e-6) << parameter_words[k].key;
    }
}

TEST(FitHierarchy, ChoosesTheModelThatMadeTheTrack) {
    auto rigid = lab_arms(false);
    rigid[viscous_1] = 0.1, rigid[viscous_2] = 0.05;
    auto result = answered(simulated(rigid, Drag::own, {.noise = 1e-3}));
    EXPECT_EQ(result.chosen().name, "rigid bodies, viscous friction");
    EXPECT_TRUE(result.uncertainty.is_white);
    auto other = result;  // the words follow the numbers
    other.uncertainty.is_white = false, other.uncertainty.neighbour = {-0.2, 0.1};
    EXPECT_NE(residual_sentence(other).find("correlated within ten samples (neighbours by -0.20 and 0.10)"),
              std::string::npos);
    other.uncertainty.neighbour = {0.9, 0.1}, other.uncertainty.memory_s = {0.12, 0.01};
    EXPECT_NE(residual_sentence(other).find("not white noise: they keep their sign for about 0.12 s;"),
              std::string::npos);
    EXPECT_NEAR(result.chosen().left_out_rms, 1e-3, 5e-5);  // measured 1.02e-3

    result = answered(simulated(ratios_of(point_masses(1.3, 1, 0.2, 0.25)), Drag::own, {.noise = 1e-3}));
    EXPECT_EQ(result.chosen().name, "point masses, no friction");
    const auto chain = pendulum_of(result.pendulum).chain;
    EXPECT_NEAR(chain.length[0], 0.2, 1e-3);
    EXPECT_NEAR(chain.length[1], 0.25, 1e-3);
    EXPECT_NEAR(chain.mass[0], 1.3, 1e-2);
}

TEST(FitUncertainty, TakesTheNoiseOfCoarseTracksForWhite) {
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        const auto track =
            simulated(lab_arms(false), Drag::own,
                      {.pieces = 8, .piece_s = 2.5, .hz = 10, .noise = 1e-3, .amplitude = 0.8, .seed = seed});
        const auto fit = fitted(model_of(false, 1), lab_arms(false), track);
        EXPECT_TRUE(uncertainty_of({track, no_stop}, fit).is_white) << seed;
    }
}

/// With the correct model, only the error of the start limits predictions; and the interval of the pieces is found.
TEST(FitHorizon, FindsTheIntervalOfPiecesAndTheHorizon) {
    auto truth = lab_arms(false);
    truth[viscous_1] = 0.05;
    const auto track = simulated(truth, Drag::own, {.pieces = 8, .piece_s = 2.5, .noise = 1e-3, .every_s = 5});
    const auto result = answered(track, Bodies::rigid);
    ASSERT_TRUE(result.period);
    EXPECT_NEAR(result.period->seconds, 5, 4 * result.period->standard_error + 1e-4);  // measured 5.0000(1)
    EXPECT_LT(result.period->standard_error, 1e-3);
    ASSERT_TRUE(result.horizon);
    EXPECT_EQ(result.horizon->left_by[0], 0);  // never limited by the model
    EXPECT_GT(result.horizon->longest_s, 5);
}

TEST(FitHorizon, DoesNotJudgeAcrossPiecesThatAreSeparateMotions) {
    auto truth = lab_arms(false);
    truth[viscous_1] = 0.05;
    auto track = simulated(truth, Drag::own, {.pieces = 4, .piece_s = 3, .noise = 1e-6, .every_s = 5});
    std::ranges::reverse(track.pieces);
    track.start_s = {0, 5, 10, 15};
    const auto result = answered(track, Bodies::rigid);
    ASSERT_TRUE(result.horizon);
    EXPECT_EQ(result.horizon->left(), 0);
    EXPECT_EQ(result.horizon->ended_by_gap, 3);
    EXPECT_FALSE(result.horizon->median_s);
    for (const auto& p : result.horizon->predictions) EXPECT_LT(p.within_s, 3);
    EXPECT_NE(horizon_sentence(result).find("3 ended at a gap"), std::string::npos);
}

/// In a track of eight pieces, the first prediction covers most of the track and the last one very little.
TEST(FitHorizon, ReportsMissingPredictionsAndTheDataUsed) {
    FitResult result;
    result.horizon = Horizon{.longest_s = 10.9};
    for (int k = 0; k < 8; ++k) result.horizon->predictions.push_back({.data_s = 1.9, .within_s = 10.9 - 1.5 * k});
    result.horizon->predictions[3].data_s = 1.12;
    // 1 − 0.05^(1/4) = 0.527
    EXPECT_EQ(horizon_sentence(result),
              "Predictions from 1.1 to 1.9 s of data stay within 0.1 rad to the end of the track, 0.4 to 10.9 s. Of "
              "the 4 that ran for 6.4 s or more, none exceeded it: at 95 % confidence at most 53 % would.");
}

TEST(FitHorizon, TakesTheMedianOfCensoredTimes) {
    EXPECT_FALSE(median_of({{1, false}, {2, false}}));
    EXPECT_EQ(median_of({{1, true}, {2, true}, {3, true}}), 2);
    // Kaplan–Meier estimate by hand: 1 − 1/5 = 0.8; × (1 − 1/3) = 0.53; × (1 − 1/2) = 0.27
    EXPECT_EQ(median_of({{1, true}, {2, false}, {3, true}, {4, true}, {5, false}}), 4);
}

}  // namespace doppel::shooting_test

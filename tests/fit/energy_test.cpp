#include "base/error.hpp"
#include "fit/result.hpp"
#include "fit/support.hpp"
#include "fit/uncertainty.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace energy_test {

using namespace test;

/// The exit code and the message that a track's fit ends with; 0 where it is taken.
std::pair<int, std::string> ending(const Track& track, Bodies bodies = Bodies::automatic) {
    try {
        answered(track, bodies);
    } catch (const Error& error) {
        return {static_cast<int>(error.code()), error.what()};
    }
    return {0, ""};
}

/// How many standard errors the loss of energy is from 0.
double errors_from_zero(const Track& track, const Parameters& guess, bool point = false) {
    const FitJob job{track, no_stop, 2};
    const auto fit = *fit_model(job, fit_at(model_of(point, 1), guess, track), {.step_share = 0.2, .relative = 5e-4});
    const auto loss = energy_loss(job, fit).value();
    return loss.share / loss.standard_error;
}

/// The second arm read `shift` samples of 2 ms later than the first, then every fifth sample kept.
Track with_lag(const Track& track, std::ptrdiff_t shift) {
    Track late = track;
    for (auto& piece : late.pieces) {
        const auto whole = piece;
        piece = {.name = whole.name, .time_s = {}, .angle = {}, .is_outlier = {}};
        for (std::ptrdiff_t i = 5; i + 5 < static_cast<std::ptrdiff_t>(whole.size()); i += 5) {
            const auto k = static_cast<std::size_t>(i);
            piece.time_s.push_back(whole.time_s[k] - whole.time_s[5]);
            piece.angle[0].push_back(whole.angle[0][k]);
            piece.angle[1].push_back(whole.angle[1][k + static_cast<std::size_t>(shift)]);
            for (auto& outliers : piece.is_outlier) outliers.push_back(0);
        }
    }
    return late;
}

TEST(FitEnergy, IsLostAsTheFrictionSays) {
    auto truth = lab_arms(false);
    truth[viscous_1] = 0.08, truth[viscous_2] = 0.03;
    const auto track = simulated(truth, Drag::own, {.noise = 1e-3});
    EXPECT_GT(errors_from_zero(track, truth), 50);             // measured 372
    EXPECT_LT(errors_from_zero(reversed(track), truth), -50);  // measured −370
}

TEST(FitEnergy, TracksPlayedBackwardsAreRefused) {
    auto viscous = lab_arms(false);
    viscous[viscous_1] = 0.02, viscous[viscous_2] = 0.01;
    for (const auto& truth : {lab_arms(), viscous}) {
        const auto track = simulated(truth, Drag::carried, {.noise = 1e-3});
        EXPECT_EQ(ending(track).first, 0);
        for (const auto bodies : {Bodies::automatic, Bodies::compound}) {
            const auto [code, words] = ending(reversed(track), bodies);
            EXPECT_EQ(code, 3);
            EXPECT_NE(words.find("gains energy"), std::string::npos) << words;
        }
    }
}

/// Nothing is lost or gained: of so many tracks none is near five standard errors.
TEST(FitEnergy, TracksWithoutFrictionAreTaken) {
    const auto truth = lab_arms(false);
    double squares = 0, largest = 0;
    constexpr unsigned tracks = 40;
    for (unsigned seed = 1; seed <= tracks; ++seed) {
        const auto track = simulated(truth, Drag::own, {.noise = 1e-3, .seed = seed});
        const double z = errors_from_zero(track, truth);
        squares += z * z;
        largest = std::max(largest, std::abs(z));
    }
    RecordProperty("rms", std::to_string(std::sqrt(squares / tracks)));
    EXPECT_LT(largest, 4);                             // measured 2.5
    EXPECT_NEAR(std::sqrt(squares / tracks), 1, 0.3);  // measured 0.96
    for (unsigned seed = 1; seed <= 2; ++seed) {
        const auto track = simulated(truth, Drag::own, {.noise = seed % 2 == 0 ? 1e-3 : 1e-5, .seed = seed});
        EXPECT_EQ(ending(track).second, "");
        EXPECT_EQ(ending(reversed(track)).second, "");
    }
}

/// Encoders that are read one after the other, in either order, are no engine.
TEST(FitEnergy, ALagIsNotTakenForEnergy) {
    const auto truth = lab_arms(false);
    for (const std::ptrdiff_t shift : {-2, -1, 1, 2})
        for (unsigned seed = 1; seed <= 4; ++seed) {
            const auto track = simulated(truth, Drag::own, {.hz = 500, .noise = 1e-3, .seed = seed});
            // measured up to 2.4; by a fit that knows no lag 3.8
            EXPECT_LT(std::abs(errors_from_zero(with_lag(track, shift), truth)), 3) << shift << " " << seed;
        }
}

}  // namespace energy_test
}  // namespace doppel

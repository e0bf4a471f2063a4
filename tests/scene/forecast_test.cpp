#include "scene/forecast.hpp"

#include "analysis/reference.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace doppel::forecast_test {

Scene scene_from(const std::string& system, int duration_s) {
    return doppel::scene_from(fmt::format(
        "[scene]\nduration_s = {}\nsample_hz = 30\n[system]\nintegrator = \"taylor\"\n{}", duration_s, system));
}

Forecast predicted(const std::string& system, int duration_s = 30) {
    const auto scene = scene_from(system, duration_s);
    return forecast_of(scene, scene.a, never);
}

TEST(Forecast, EstimatesThePredictabilityLimitInDouble) {
    for (const char* system : {"angle_deg = [90, 90]", "angle_deg = [150, 90]",
                               "angle_deg = [120, -60]\nmass_kg = [2, 1]", "links = 3\nangle_deg = [120, 0, 0]"}) {
        const auto scene = scene_from(system, 40);
        const auto limit = forecast_of(scene, scene.a, never).limit;
        ASSERT_TRUE(limit) << system;
        EXPECT_LE(limit->from, limit->to);
        // other runs, by methods and equations that the forecast does not use
        const auto reference = reference_trajectory(scene.a.motion, scene.samples, scene.a.reach, 0.5, never);
        for (const auto& [model, method, tolerance] : {std::tuple{Model::angles, "dop853", "1e-14"},
                                                       {Model::constraints, "taylor", "1e-15"},
                                                       {Model::constraints, "taylor", "1e-14"},
                                                       {Model::angles, "taylor", "5e-15"}}) {
            auto other = scene.a.motion;
            other.model = model;
            other.method = method;
            other.tolerance = parse_quad(tolerance);
            const double lost =
                scene.time(static_cast<long>(error_history(other, reference, 0.5, never).error.size()) - 1);
            EXPECT_GT(lost, 0.9 * limit->from) << system << ": " << method;  // measured 0.98
            EXPECT_LT(lost, 1.15 * limit->to) << system << ": " << method;   // measured 1.07
        }
    }
}

TEST(Forecast, EstimatesTheFinalErrorOfAccurateRuns) {
    EXPECT_EQ(predicted("angle_deg = [30, 0]", 5).error_s, 5);
}

TEST(Forecast, ARunSaysWhatTheCheckSays) {
    // near the limit of double, where a reference in double is not exact enough: it said 27.6 s
    const auto scene = make_scene(read_preset(find_preset("phase-dance")));
    const auto told = forecast_of(scene, scene.a, never);
    EXPECT_NEAR(told.error_s, 28.57, 0.05);
    EXPECT_EQ(early_error(scene, scene.a, scene.samples, never), error_words(scene.a, told.error_s));
}

// The Taylor series that checks a run in double cannot pass the bounce of a very light mass; dop853 can.
TEST(Forecast, EndsWhereTheReferenceEnds) {
    const std::string angles = "angle_deg = [100, -60]\nmass_kg = ";
    const auto told = [&](const char* mass) {
        const auto scene = scene_from(angles + mass, 2);
        auto side = scene.a;
        side.motion.method = "dop853";
        side.motion.tolerance = parse_quad("1e-13");
        return forecast_of(scene, side, never);
    };
    const auto part = told("[1e-10, 1]"), whole = told("[1e-9, 1]");
    EXPECT_NEAR(part.error_s, 0.58382, 1.0 / 30);  // free fall until both rods are in line
    EXPECT_LT(part.error, 1e-12);
    EXPECT_FALSE(part.is_off() || part.limit);
    EXPECT_EQ(whole.error_s, 2);
    EXPECT_LT(whole.error, 1e-9);
}

TEST(Forecast, ReportsDivergenceBeforeTheEnd) {
    // the forecast from ten seconds agrees with that from forty
    const auto shown = *predicted("angle_deg = [90, 90]", 40).limit,
               told = *predicted("angle_deg = [90, 90]", 10).limit;
    EXPECT_NEAR(told.from / shown.from, 1, 0.3);  // measured 0.23
    EXPECT_GT(told.to, 0.9 * shown.to);
    EXPECT_LT(told.to, 2.4 * shown.to);                    // measured 1.91
    EXPECT_FALSE(predicted("angle_deg = [30, 0]").limit);  // regular: no limit
}

TEST(Forecast, DistinguishesAnUnstableEquilibriumFromChaos) {
    using Kind = Forecast::Kind;
    const auto upright = predicted("links = 1\nangle_deg = [180]", 5);
    EXPECT_EQ(upright.kind, Kind::unstable);
    EXPECT_NEAR(upright.exponent->value, std::sqrt(9.8), 1e-12);
    EXPECT_EQ(predicted("angle_deg = [180, 0]", 5).kind, Kind::unstable);
    EXPECT_EQ(predicted("angle_deg = [0, 0]", 5).kind, Kind::regular);
    EXPECT_EQ(predicted("links = 1\nangle_deg = [179.999]", 5).kind, Kind::regular);
    EXPECT_EQ(predicted("angle_deg = [30, 0]", 5).kind, Kind::regular);
    EXPECT_EQ(predicted("angle_deg = [90, 90]", 5).kind, Kind::chaotic);
    // with a spring it is another system, to which the chain's exponent does not apply
    EXPECT_FALSE(predicted("angle_deg = [90, 90]\n[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [2, 0]", 5)
                     .exponent);
}

}  // namespace doppel::forecast_test

#include "film/runs.hpp"

#include <gtest/gtest.h>

namespace doppel::manifest_test {

// Released level, side b has almost no energy: the relative error of explicit Euler is meaningless there.
TEST(Manifest, SaysTheEnergyErrorInJoulesAndOfThePotentialRange) {
    const auto side = manifest_of(scene_of("butterfly", {"scene.duration_s=5"}))["b"];
    const double range = 2 * 9.81 * (1 * 1 + 1 * 2);  // J: 2 g Σ m · height, 1 kg each at 1 m and at 2 m
    EXPECT_NEAR(side["energy_range_J"].get<double>(), range, 0.01 * range);
    const double change = side["worst_energy_change_J"], of_range = side["worst_energy_error_of_range"];
    EXPECT_NEAR(of_range, change / side["energy_range_J"].get<double>(), 1e-15);
    EXPECT_GT(of_range, 1e-6);
    EXPECT_LT(of_range, 0.05);  // measured 0.002
    EXPECT_GT(side["worst_energy_error"].get<double>(), 100 * of_range);
    // each side by its own range
    const auto uneven = manifest_of(scene_of("butterfly", {"scene.duration_s=1", "a.mass_kg=[3, 3]"}));
    EXPECT_NEAR(uneven["a"]["energy_range_J"].get<double>(), 3 * range, 0.03 * range);
    EXPECT_EQ(uneven["b"]["energy_range_J"], side["energy_range_J"]);
}

// Runge–Kutta 4 loses energy at steps of 1/10 s; faster swings lose more.
TEST(Manifest, WarnsWhereEnergyIsNotKept) {
    const std::vector<std::string> coarse{"system.integrator=\"rk4\"", "system.step_s=\"1/10\"", "scene.sample_hz=10",
                                          "video.fps=10", "scene.duration_s=20"};
    const auto warnings = manifest_of(scene_of("butterfly", coarse))["warnings"];
    ASSERT_EQ(warnings.size(), 4u);
    const std::string first = warnings[0], third = warnings[2];
    EXPECT_TRUE(third.starts_with("side a: error above half a rad from ")) << third;
    EXPECT_NE(first.find("the energy of side a changed by "), std::string::npos) << first;
    EXPECT_NE(first.find("1/10 s is too coarse for 20 s"), std::string::npos) << first;
    EXPECT_TRUE(manifest_of(scene_of("butterfly", {"scene.duration_s=5"}))["warnings"].empty());
    // friction reduces the energy: no error
    EXPECT_TRUE(manifest_of(scene_of("springs", {"scene.duration_s=2"}))["warnings"].empty());
}

TEST(Manifest, WarnsOfSidesWithoutADifference) {
    const auto warnings =
        manifest_of(scene_of("butterfly", {"scene.duration_s=1", "b.angle_deg=[90, 90]"}))["warnings"];
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0], "both sides are the same; give [b] a difference, or take layout = \"single\"");
}

TEST(Manifest, ContainsThePredictabilityLimit) {
    EXPECT_TRUE(manifest_of(scene_of("butterfly", {"scene.duration_s=1"}))["horizon_s"]
                    .is_null());  // its steps are set by the user
    const auto chosen = manifest_of(scene_of("horizon"));
    EXPECT_EQ(chosen["horizon_s"],
              std::min(chosen["a"]["accuracy"]["horizon_s"], chosen["b"]["accuracy"]["horizon_s"]));
    EXPECT_EQ(chosen["a"]["accuracy"]["unit"], "rad");
    EXPECT_GT(chosen["horizon_s"], 25);  // measured 32.3, of 40
    EXPECT_LT(chosen["horizon_s"], 40);
    const auto& time = chosen["time"];
    EXPECT_GT(time["cpu_by_stage_s"]["choose"], 0.02);  // measured 0.7
    EXPECT_GT(time["cpu_s"], time["cpu_by_stage_s"]["choose"]);
    EXPECT_GT(time["wall_s"], 0.02);
}

}  // namespace doppel::manifest_test

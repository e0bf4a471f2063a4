#include "film/runs.hpp"
#include "scene/captions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::unlike_sides_test {

/// A rod of 2 m on one side, a spring of 1 m on the other.
const std::string chain_and_spring =
    "[a]\nlinks = 1\nlength_m = 2\n[[b.particle]]\nname = \"bob\"\nposition_m = [1, 0]\n[[b.force]]\nkind = "
    "\"spring\"\n"
    "from = [0, 0]\nto = \"bob\"\nstiffness_N_per_m = 60\n[system]\nintegrator = \"dop853\"\n[scene]\nduration_s = 2\n";

TEST(UnlikeSides, TheSingleOneComesBackAfterTheExactPeriodAndTheDoubleOneDoesNot) {
    // Gauss 1799: T = 2π √(l/g) / agm(1, cos(A/2))
    double a = 1, b = std::cos(radians(60.0));
    for (int i = 0; i < 10; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    const double period = 2 * pi * std::sqrt(2 / 9.8) / a;
    const auto scene = scene_of("single-and-double", {"scene.sample_hz=1000"});
    PairRun pair(scene);
    auto state = pair.next(never_stopped);
    const auto start_a = state.a.bobs.back(), start_b = state.b.bobs.back();
    EXPECT_NEAR(state.distance, 0, 1e-15);  // they start at the same place, at rest
    double back_a = 1e9, back_b = 1e9;      // m, smallest distance from the start within 2 ms of the period
    for (long n = 1; n <= std::lround(1000 * period) + 2; ++n) {
        state = pair.next(never_stopped);
        if (std::abs(scene.time(n) - period) > 2e-3) continue;
        back_a = std::min(back_a, std::hypot(state.a.bobs.back().x - start_a.x, state.a.bobs.back().y - start_a.y));
        back_b = std::min(back_b, std::hypot(state.b.bobs.back().x - start_b.x, state.b.bobs.back().y - start_b.y));
    }
    EXPECT_LT(back_a, 2e-6);  // m; at most ½ (g sin A) (0.5 ms)²
    EXPECT_GT(back_b, 0.1);
}

TEST(UnlikeSides, AreComparedByTheirLastMasses) {
    for (const auto& scene : {scene_of("single-and-double"), scene_of_text(chain_and_spring)}) {
        const auto state = state_at(scene, 99);
        const auto &a = state.a.bobs.back(), &b = state.b.bobs.back();
        const double squares = std::pow(a.mass - b.mass, 2) + std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2) +
                               std::pow(a.vx - b.vx, 2) + std::pow(a.vy - b.vy, 2);
        EXPECT_NEAR(state.distance, std::sqrt(squares), 1e-14 * state.distance);
        EXPECT_GT(state.distance, 0.1);
    }
}

TEST(UnlikeSides, AreCalledWhatTheyAre) {
    const auto single = scene_of("single-and-double");
    EXPECT_EQ(side_captions(single)[0].heading, "pendulum");
    EXPECT_EQ(side_captions(single)[1].heading, "double pendulum");
    EXPECT_EQ(side_captions(single)[1].note, "θ₁ = 120°, θ₂ = 120°");
    EXPECT_TRUE(scene_caption(single).starts_with("a pendulum and a double pendulum, released at rest"));
    EXPECT_EQ(side_captions(scene_of_text(chain_and_spring))[1].heading, "mechanism of one mass");
}

TEST(UnlikeSides, HaveTheColumnsOfTheirMasses) {
    const auto header = table_of(scene_of("single-and-double", {"scene.duration_s=0.1"})).at(0);
    EXPECT_TRUE(header.starts_with(
        "sample,time_s,a_theta1_rad,a_omega1_rad_per_s,a_x1_m,a_y1_m,a_vx1_m_per_s,a_vy1_m_per_s,a_energy_J,"
        "a_energy_error,a_length_error_m,b_theta1_rad,b_theta2_rad,b_omega1_rad_per_s,b_omega2_rad_per_s,b_x1_m,"));
}

TEST(UnlikeSides, AreDrawnInEveryLayoutThatTakesThem) {
    for (const char* layout : {"side-by-side", "overlay", "portrait"})
        for (const std::string& text : {std::string("[a]\nlinks = 1\n[scene]\nduration_s = 0.2\n"), chain_and_spring}) {
            const auto scene = scene_of_text(text + fmt::format("[video]\nlayout = \"{}\"\nsize = [180, 320]", layout));
            const auto picture = frame_of(scene, 20);
            const auto panels = make_layout(scene).panels;
            const auto last = state_at(scene, 20);
            for (const std::size_t side : {0, 1}) {
                const auto& bob = (side == 0 ? last.a : last.b).bobs.back();
                const auto& panel = panels[panels.size() == 1 ? 0 : side];
                EXPECT_TRUE(is_color(picture, panel.at(bob.x, bob.y), themes[0].sides[side]))
                    << layout << ", side " << side;
            }
        }
    test::expect_error(ExitCode::bad_input,
                       {"[video] layout \"ensemble\" interpolates between the sides, so both need the same number of "
                        "links; they have 1 and 2"},
                       [] { scene_of("single-and-double", {"video.layout=\"ensemble\""}); });
    test::expect_error(ExitCode::bad_input, {"phase_link must be from 1 to 1"},
                       [] { scene_of("single-and-double", {"video.layout=\"phase\""}); });
}

}  // namespace doppel::unlike_sides_test

#include "film/runs.hpp"
#include "output/written.hpp"
#include "scene/resolved.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::run_table_test {

TEST(RunTable, HasTheColumnsOfTheContract) {
    const auto lines = table_of(small_scene());
    EXPECT_EQ(lines.front(),
              "sample,time_s,"
              "a_theta1_rad,a_theta2_rad,a_omega1_rad_per_s,a_omega2_rad_per_s,"
              "a_x1_m,a_y1_m,a_vx1_m_per_s,a_vy1_m_per_s,a_x2_m,a_y2_m,a_vx2_m_per_s,a_vy2_m_per_s,"
              "a_energy_J,a_energy_error,a_length_error_m,"
              "b_theta1_rad,b_theta2_rad,b_omega1_rad_per_s,b_omega2_rad_per_s,"
              "b_x1_m,b_y1_m,b_vx1_m_per_s,b_vy1_m_per_s,b_x2_m,b_y2_m,b_vx2_m_per_s,b_vy2_m_per_s,"
              "b_energy_J,b_energy_error,b_length_error_m,"
              "distance,log_ratio");
    ASSERT_EQ(lines.size(), 62u);
    const auto first = cells_of(lines[1]), last = cells_of(lines.back());
    EXPECT_EQ(first[0], "0");
    EXPECT_EQ(first[2], fmt::format("{}", pi / 2));
    EXPECT_EQ(first.back(), "0");  // ln(d0/d0)
    EXPECT_EQ(last[0], "60");
    EXPECT_EQ(last[1], "0.5");
}

TEST(RunTable, GivesEveryQuadBack) {
    const auto scene = small_scene({"system.precision=\"quad\"", "system.step_s=\"1/480\""});
    const auto lines = table_of(scene);
    PairRun pair(scene);
    std::size_t longest = 0;
    for (std::size_t row = 1; row < lines.size(); ++row) {
        const auto state = pair.next(never_stopped);
        const auto cells = cells_of(lines[row]);
        std::size_t column = 2;
        const auto expect = [&](const Quad& value) {
            EXPECT_EQ(parse_quad(cells[column]), value) << row << " " << column;
            longest = std::max(longest, cells[column++].size());
        };
        for (const auto* side : {&state.a, &state.b}) {
            for (const auto& bob : side->exact) expect(bob.theta);
            for (const auto& bob : side->exact) expect(bob.omega);
            for (const auto& bob : side->exact)
                for (const auto& value : {bob.x, bob.y, bob.vx, bob.vy}) expect(value);
            EXPECT_EQ(std::stod(cells[column]), side->energy);
            column += 3;
        }
    }
    EXPECT_GE(longest, 36u);
}

TEST(RunTable, HasTheColumnsThatAreChosenInTheirOrder) {
    const auto scene =
        small_scene({"scene.energy_columns=true", "system.precision=\"quad\"", "system.step_s=\"1/480\""});
    const auto all = table_of(scene);
    const auto names = cells_of(all[0]);
    const auto chosen = [&](const std::vector<std::string>& columns, const auto& is_chosen) {
        const auto few = table_of(scene, columns);
        ASSERT_EQ(few.size(), all.size());
        for (std::size_t k = 0; k < all.size(); ++k) {
            const auto cells = cells_of(all[k]);
            std::string expected;
            for (std::size_t i = 0; i < names.size(); ++i)
                if (is_chosen(names[i])) expected += (expected.empty() ? "" : ",") + cells[i];
            EXPECT_EQ(few[k], expected) << k;
        }
    };
    chosen({"distance", "time_s", "a_theta2_rad", "time_s"},
           [](const auto& name) { return name == "time_s" || name == "a_theta2_rad" || name == "distance"; });
    chosen({"b"}, [](const auto& name) { return name.starts_with("b_"); });
    chosen({"a", "sample"}, [](const auto& name) { return name.starts_with("a_") || name == "sample"; });
}

TEST(RunTable, RefusesColumnsThatItDoesNotHave) {
    const auto scene = small_scene();
    for (const std::string name : {"a_theta3_rad", "c", "", "a_kinetic_J", "*", "a_"})
        test::expect_error(
            ExitCode::bad_input,
            {"--columns: the table of butterfly has no \"" + name + "\"; ", "it has sample, time_s, a_theta1_rad,"},
            [&] {
                check_run(scene, {.columns = {"time_s", name}});
            });
    test::expect_error(ExitCode::bad_input, {"did you mean"}, [&] { check_run(scene, {.columns = {"a_theta3_rad"}}); });
}

TEST(RunTable, HasTheEnergiesLastWhereTheyAreAskedFor) {
    const auto lines = table_of(small_scene({"scene.energy_columns=true"})), plain = table_of(small_scene());
    ASSERT_EQ(lines.size(), plain.size());
    EXPECT_EQ(lines[0], plain[0] + ",a_kinetic_J,a_potential_J,b_kinetic_J,b_potential_J");
    for (std::size_t k = 1; k < lines.size(); ++k) {
        EXPECT_TRUE(lines[k].starts_with(plain[k] + ",")) << k;  // the original columns are unchanged
        const auto cells = cells_of(lines[k]);
        const auto at = [&](std::size_t from_end) { return std::stod(cells[cells.size() - from_end]); };
        // m g (y1 + y2) of side a, and ½ m v²
        const auto cell = [&](std::size_t column) { return std::stod(cells[column]); };
        EXPECT_NEAR(at(3), 9.8 * (cell(7) + cell(11)), 1e-12) << k;  // measured 4e-15
        EXPECT_NEAR(at(4), 0.5 * (cell(8) * cell(8) + cell(9) * cell(9) + cell(12) * cell(12) + cell(13) * cell(13)),
                    1e-12)
            << k;
    }
    const auto again =
        read_preset({"x", "x.toml", resolved_toml(small_scene({"scene.energy_columns=true"}).preset), "x.toml"});
    EXPECT_TRUE(again.energy_columns);
}

TEST(RunTable, LeavesTheLogRatioEmptyForEqualStarts) {
    const auto lines = table_of(scene_of("two-methods", {"scene.duration_s=0.1"}));
    EXPECT_EQ(lines.size(), 14u);
    for (const auto& line : lines) EXPECT_TRUE(line.ends_with("log_ratio") || line.ends_with(","));
}

TEST(RunTable, LeavesTheEnergyErrorOpenWhereDampingTakesEnergy) {
    const auto scene = scene_of_text(R"(
[scene]
duration_s = 0.1
[system]
integrator = "rk4"
step_s = "1/1200"
[[b.force]]
kind = "spring"
from = "bob2"
to = [0, -3]
damping_N_s_per_m = 2
)");
    const auto lines = table_of(scene);
    const auto header = cells_of(lines[0]), last = cells_of(lines.back());
    const auto cell = [&](const char* name) {
        return last[static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin())];
    };
    EXPECT_EQ(header.size(), last.size());
    EXPECT_NE(cell("a_energy_error"), "");
    EXPECT_EQ(cell("b_energy_error"), "");
    EXPECT_NE(cell("b_energy_J"), "");
    EXPECT_NE(cell("b_length_error_m"), "");
    const auto manifest = manifest_of(scene);
    EXPECT_TRUE(manifest["a"]["worst_energy_error"].is_number());
    EXPECT_EQ(manifest["a"]["conserves_energy"], true);
    EXPECT_TRUE(manifest["b"]["worst_energy_error"].is_null());
    EXPECT_EQ(manifest["b"]["conserves_energy"], false);
}

}  // namespace doppel::run_table_test

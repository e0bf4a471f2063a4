#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <map>

namespace doppel {
namespace kinds_test {

// What the figures that settle open questions must show, whatever their pictures look like.

std::map<std::string, double> findings_of(const FigurePreset& figure) {
    std::map<std::string, double> found;
    for (const auto& finding : figure.experiment->findings(computed(figure)))
        if (const auto* number = std::get_if<double>(&finding.value)) found[finding.key] = *number;
    return found;
}

TEST(Convergence, FallsByThePowerOfTheOrder) {
    const auto found = findings_of(
        figure_of("why-they-part", {"scene.duration_s=0.5", "convergence.methods=[\"euler\", \"midpoint\", \"rk4\"]",
                                    "convergence.halvings=3", "convergence.quad_halvings=5"}));
    for (const auto& [method, order] : {std::pair{"euler", 1}, {"midpoint", 2}, {"rk4", 4}})
        EXPECT_NEAR(found.at(std::string("slope_") + method), order, 0.01) << method;  // measured 0.0015
}

TEST(Convergence, ListsEveryRung) {
    const auto table = table_of(figure_of("why-they-part", {"scene.duration_s=0.1", "convergence.methods=[\"euler\"]",
                                                            "convergence.halvings=3", "convergence.quad_halvings=2"}));
    ASSERT_EQ(table.rows.size(), 4u + 3u);
    for (std::size_t i = 0; i + 1 < 4; ++i) EXPECT_DOUBLE_EQ(table.rows[i][2], 2 * table.rows[i + 1][2]);
    EXPECT_DOUBLE_EQ(table.rows[0][2], 1.0 / 120);
}

TEST(Spectrum, ComesInPairsThatSumToZero) {
    const auto table = table_of(figure_of("lyapunov-spectrum", {"spectrum.duration_s=100", "spectrum.samples=20"}));
    EXPECT_EQ(table.columns.front(), "time_s");
    EXPECT_EQ(table.columns.back(), "sum_per_s");
    ASSERT_EQ(table.columns.size(), 6u);
    ASSERT_EQ(table.rows.size(), 20u);
    const auto& last = table.rows.back();
    EXPECT_DOUBLE_EQ(last[0], 100);
    EXPECT_NEAR(last[1] + last[2] + last[3] + last[4], last[5], 1e-15);  // measured 0
    EXPECT_NEAR(last[5], 0, 2e-12);                                      // measured 2e-13
    EXPECT_NEAR(last[1], -last[4], 0.05);                                // measured 0.01; they settle as 1/t
    EXPECT_GT(last[1], 0.5);                                             // 90°/90° is chaotic
}

TEST(Section, SaysWhoseColourIsWhose) {
    const auto caption = [](const std::string& orbits) {
        const auto figure =
            figure_of("poincare", {"section.energy_J=[9.8]", "section.orbits=" + orbits, "section.crossings=1"});
        Figure page;
        figure.experiment->draw(computed(figure), page);
        return page.captions.front();
    };
    EXPECT_EQ(caption("8").find("Every colour is one orbit. Closed curves"), 0u);
    EXPECT_EQ(
        caption("24").find("An orbit has one colour throughout; of the 24 orbits to an energy, 3 share each of 8"), 0u);
    EXPECT_NE(caption("9").find("several share each of 8 colours"), std::string::npos);
}

TEST(Section, HasPointsThatTheEnergyAllows) {
    const auto table =
        table_of(figure_of("poincare", {"section.energy_J=[9.8, 20]", "section.orbits=3", "section.crossings=10"}));
    EXPECT_EQ(table.columns, (std::vector<std::string>{"energy_J", "orbit", "time_s", "theta2_rad", "p2_N_m_s"}));
    EXPECT_EQ(table.rows.size(), 2u * 3 * 10);
    double time = 0, orbit = -1;
    for (const auto& row : table.rows) {
        // with θ1 = 0 and ω1 free: E ≥ p2² / (2 m2 l2²) + m2 g l2 (1 − cosθ2)
        EXPECT_LE(row[4] * row[4] / 2 + 9.8 * (1 - std::cos(row[3])), row[0] * (1 + 1e-9));
        EXPECT_TRUE(row[1] != orbit || row[2] > time) << row[2];
        time = row[2];
        orbit = row[1];
    }
}

TEST(FlipMap, ForbidsWhatTheEnergyForbids) {
    const auto figure = figure_of(
        "flip-map", {"flip_map.columns=40", "flip_map.rows=40", "flip_map.duration_s=5", "flip_map.checked=20"});
    const auto table = table_of(figure);
    ASSERT_EQ(table.rows.size(), 1600u);
    int flipped = 0;
    for (const auto& row : table.rows) {
        // a rod upright, the other hanging: E ≥ −m2 g l2 … of equal links: 3 − 2 = 2 cosθ1 + cosθ2
        const bool forbidden = 2 * std::cos(row[0] * pi / 180) + std::cos(row[1] * pi / 180) > 1;
        EXPECT_TRUE(!forbidden || std::isnan(row[2])) << row[0] << " " << row[1];
        flipped += !std::isnan(row[2]);
    }
    EXPECT_GT(flipped, 300);
    const auto found = findings_of(figure);
    EXPECT_DOUBLE_EQ(found.at("share_that_flips"), flipped / 1600.0);
    EXPECT_EQ(found.at("checked_within_10_ms"), 1);
    EXPECT_LT(found.at("within_10_ms_at_least"), 1);  // a few that were drawn by lot are not all
}

TEST(Curves, CheckToleranceTellsUntilWhenTheyStand) {
    const auto found = findings_of(figure_of("fig2-left", {"scene.duration_s=2", "system.integrator=\"dop853\"",
                                                           "system.tolerance=1e-10", "curves.check_tolerance=1e-12"}));
    EXPECT_EQ(found.at("agrees_until_s_log_ratio"), 2);
    EXPECT_EQ(header_line(figure_of("fig2-left", {"system.integrator=\"dop853\"", "system.tolerance=1e-10",
                                                  "curves.check_tolerance=1e-12"})),
              "sample,time_s,log_ratio");
}

}  // namespace kinds_test
}  // namespace doppel

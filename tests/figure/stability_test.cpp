#include "analysis/stability.hpp"

#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::stability_test {

/// One row at an angle so small that linear theory is valid while the energy grows a hundredfold.
std::vector<std::string> small_angle(const std::string& method, double from, double to, int columns) {
    return {fmt::format("grid.panel.values=[\"{}\"]", method),
            "grid.y.points=2",
            "grid.y.to=0.2",
            fmt::format("grid.x.points={}", columns),
            fmt::format("grid.x.from={}", from),
            fmt::format("grid.x.to={}", to),
            "scene.sample_hz=\"5/2\"",
            "scene.duration_s=40"};
}

double limit_of(const std::string& method) {
    Pendulum<double> p{.angle = {radians(0.1), 0}};
    return step_limit(method, small_oscillations(p), 40, failure_error).value();
}

TEST(Stability, RespectsTheLinearLimit) {
    for (const std::string method : {"semi-implicit-euler", "rk4", "adams", "rattle", "rattle6"}) {
        const double limit = limit_of(method);
        // rattle6 is stable again from 1.15 to 1.31 of its limit
        const auto table = table_of(figure_of("stability", small_angle(method, 0.8 * limit, 1.13 * limit, 24)));
        ASSERT_EQ(table.rows.size(), 2 * 24u);
        int below = 0, above = 0;
        for (const auto& row : table.rows) {
            const bool is_below = row[1]<0.97 * limit, is_above = row[1]> 1.05 * limit;
            if (is_below || is_above) {
                EXPECT_EQ(std::isnan(row[4]), is_above) << method << " " << row[1] / limit;
            }
            below += is_below;
            above += is_above;
        }
        EXPECT_GT(below, 5) << method;
        EXPECT_GT(above, 2) << method;
    }
    // the limits themselves: z = 2 and 2 √2 of ω = 5.7844/s, slightly higher after too short a time
    EXPECT_NEAR(limit_of("rattle") * 5.7844, 2, 0.001);               // measured 0.0001
    EXPECT_NEAR(limit_of("rk4") * 5.7844, 2 * std::sqrt(2.0), 0.02);  // measured 0.013
}

TEST(Stability, FindsTheStableIslandsBeyondTheLimit) {
    // trace of rattle6: stable from z = 2.9195 to 3.329
    const auto table = table_of(figure_of("stability", small_angle("rattle6", 2.96 / 5.7844, 3.28 / 5.7844, 6)));
    for (const auto& row : table.rows) EXPECT_FALSE(std::isnan(row[4])) << row[1] * 5.7844;
}

TEST(Stability, OfEulerGrowsByOnePlusZSquaredAStep) {
    const auto table = table_of(figure_of("stability", small_angle("euler", 5e-4, 3e-3, 5)));
    for (const auto& row : table.rows) {
        // half of the energy in each mode: ω² = 9.8 (2 ∓ √2)
        const double h = row[1], steps = 40 / h;
        const double grown = 0.5 * std::pow(1 + 9.8 * (2 - std::sqrt(2.0)) * h * h, steps) +
                             0.5 * std::pow(1 + 9.8 * (2 + std::sqrt(2.0)) * h * h, steps);
        EXPECT_NEAR((row[4] + 1) / grown, 1, 3e-4) << h;  // measured 6e-5
    }
}

TEST(Stability, OverTheMassRatioFollowsItsFrequency) {
    const auto table =
        table_of(figure_of("stability-mass", {"grid.panel.values=[\"rattle\"]", "grid.y.points=5", "grid.x.points=40",
                                              "scene.duration_s=40", "scene.sample_hz=\"5/2\"", "grid.x.from=0.03",
                                              "system.angle_deg=[0.05, 0]"}));
    ASSERT_EQ(table.rows.size(), 200u);
    EXPECT_EQ(table.columns[3], "mass_ratio");
    for (const auto& row : table.rows) {
        const double mu = 1 / row[3];
        const double z = row[1] * std::sqrt(9.8 * (1 + mu) * (1 + std::sqrt(mu / (1 + mu))));
        if (z < 1.94 || z > 2.1) {
            EXPECT_EQ(std::isnan(row[4]), z > 2) << row[3] << " " << row[1];
        }
    }
}

TEST(Stability, HasWholeStepsNearThoseAskedFor) {
    const auto figure = figure_of("stability", {"grid.panel.values=[\"euler\"]", "grid.y.points=2", "grid.x.from=0.002",
                                                "grid.x.points=50", "scene.duration_s=1", "scene.sample_hz=100"});
    for (const auto& row : table_of(figure).rows) {
        const double steps = 1 / row[1];
        EXPECT_NEAR(steps, std::round(steps), 3e-13);  // measured 5.7e-14
    }
    const auto table = table_of(figure);
    const double ratio = std::pow(500.0, 1 / 50.0);
    for (std::size_t column = 0; column < 40; ++column) {
        const double requested = 0.002 * std::pow(ratio, static_cast<double>(column) + 0.5);
        EXPECT_NEAR(table.rows[column][1] / requested, 1, std::max(0.006, requested / 2)) << requested;
    }
}

TEST(Stability, SharesItsAxes) {
    EXPECT_EQ(figure_of("stability").experiment->trials(), 12u * 140);
    const auto page_of_methods = [](const std::string& methods) {
        return page_of(figure_of(
            "stability", {"grid.x.points=2", "grid.y.points=2", "scene.duration_s=1", "grid.panel.values=" + methods}));
    };
    // nine with fixed steps, three with a tolerance: rows of three of one sort
    const auto all = page_of_methods(
        "[\"euler\", \"semi-implicit-euler\", \"midpoint\", \"rk4\", \"adams\", \"gauss4\", "
        "\"gauss6\", \"rattle\", \"rattle6\", \"dopri5\", \"dop853\", \"taylor\"]");
    EXPECT_TRUE(all.shares_axes);
    EXPECT_EQ(all.columns, 3);
    ASSERT_EQ(all.panels.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(all.panels[i].x, all.panels[i < 9 ? 0 : 9].x) << i;
        EXPECT_EQ(all.panels[i].y, all.panels[0].y) << i;
        for (const auto& rule : all.panels[i].rules) EXPECT_EQ(rule.label, "");  // no labels on the maps
    }
    EXPECT_NE(all.panels[0].x, all.panels[9].x);
    EXPECT_TRUE(all.panels[3].note.starts_with("limit 0."));  // of rk4
    EXPECT_EQ(all.panels[6].note, "");                        // Gauss collocation has no limit
    EXPECT_EQ(page_of_methods("[\"rk4\", \"taylor\"]").columns, 0);
}

}  // namespace doppel::stability_test

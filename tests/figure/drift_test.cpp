#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::drift_test {

const std::string kind = "[scene]\nkind = \"series\"\n";

/// The preset's double pendulum, for a short time.
FigurePreset short_drift(int seconds, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{fmt::format("series.duration_s={}", seconds), "series.points_per_decade=5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return figure_of("drift", arguments);
}

TEST(Drift, EulerGainsEnergyByTheClosedForm) {
    // a pendulum of small amplitude: E + m g l grows by 1 + z² a step, z² = h² g/l; E0 = −m g l cos A
    const double amplitude = 0.1 * pi / 180, h = 1.0 / 200, z2 = h * h * 9.8;
    const auto figure = figure_from(
        kind +
        "[system]\nlinks = 1\nangle_deg = [0.1]\n"
        "[series]\nquantity = \"errors\"\nevaluations_per_s = 200\nduration_s = 40\nmethods = [\"euler\"]\n");
    const auto table = table_of(figure);
    ASSERT_EQ(table.rows.size(), 2u * 18);  // minimal coordinates first, then constraints
    for (std::size_t i = 0; i < 18; ++i) {
        const double time = table.rows[i][3];
        // the last check in a window has the largest error; there are four checks per second
        const double steps = std::floor(time * 4 + 1e-9) / 4 / h;
        const double gained = std::expm1(steps * std::log1p(z2)) * (1 - std::cos(amplitude)) / std::cos(amplitude);
        EXPECT_EQ(table.rows[i][2], h);
        EXPECT_NEAR(table.rows[i][4] / gained, 1, 1e-5) << time;  // measured 3.4e-6
    }
}

TEST(Drift, EveryMethodTakesItsEvaluations) {
    const auto found = findings_of(short_drift(40));
    int counted = 0;
    for (const auto& [key, value] : found.items()) {
        if (!key.ends_with("_evaluations_per_s")) continue;
        ++counted;
        if (key.starts_with("taylor")) {
            EXPECT_LT(value, 500) << key;  // 446: even the smallest tolerance needs no more evaluations
            EXPECT_EQ(found.at(key.substr(0, key.find("_eval")) + "_setting"), 8.89e-16);
        } else {
            EXPECT_NEAR(value, 500, 5) << key;  // measured 499.6 … 501.8
        }
    }
    EXPECT_EQ(counted, 10 + 10 + 1);
    EXPECT_EQ(found.at("rk4_angles_setting"), 1 / 125.0);
    EXPECT_EQ(found.at("adams_angles_setting"), 1 / 250.0);
}

TEST(Drift, FindsTheLawOfGrowth) {
    const auto found = findings_of(
        short_drift(200, {"series.methods=[\"euler\", \"rk4\", \"dopri5\", \"gauss6\", \"rattle\", \"rattle6\"]"}));
    for (const char* name : {"gauss6_angles", "rattle_constraints", "rattle6_constraints"})
        EXPECT_NEAR(found.at(std::string(name) + "_energy_exponent"), 0, 0.2) << name;  // measured 0.16, 0.09, 0.03
    for (const char* name : {"rk4_angles", "dopri5_angles", "rk4_projected_constraints"})
        EXPECT_NEAR(found.at(std::string(name) + "_energy_exponent"), 1, 0.12) << name;  // measured 0.91, 1.00, 0.96
    for (const char* name : {"rk4_constraints", "dopri5_constraints"})
        EXPECT_NEAR(found.at(std::string(name) + "_rods_exponent"), 2, 0.05) << name;  // measured 2.01
    EXPECT_EQ(found.at("rk4_angles_energy_growth"), "grows linearly");
    EXPECT_EQ(found.at("rk4_constraints_rods_growth"), "grows like t²");
    EXPECT_EQ(found.at("gauss6_angles_energy_growth"), "stays bounded");
    EXPECT_EQ(found.at("euler_angles_energy_growth"), "fails");
    EXPECT_NEAR(found.at("euler_angles_broken_at_s"), 87, 1);  // measured 87.25
}

TEST(Drift, HasNoRodErrorForMethodsThatPreserveRods) {
    const auto table =
        table_of(short_drift(200, {"series.methods=[\"semi-implicit-euler\", \"rattle\", \"rattle6\"]"}));
    ASSERT_EQ(table.rows.size(), 5u * 13);
    // the methods that conserve the constraints come last: rattle, rattle6 and projected rk4
    for (std::size_t i = 2 * 13; i < table.rows.size(); ++i) EXPECT_LT(table.rows[i][5], 2e-15);  // measured 2e-16
    EXPECT_GT(table.rows[2 * 13 - 1][5], 0.05);  // measured 0.27: the others do not conserve them
    for (const auto& row : table.rows) {
        EXPECT_LT(row[4], 1);
        EXPECT_LT(row[5], 1);
        EXPECT_LE(row[3], 200);
    }
    EXPECT_EQ(table.columns,
              (std::vector<std::string>{"method", "model", "setting", "time_s", "energy_error", "length_error_m"}));
}

TEST(Drift, SummarisesTheResultInOneLine) {
    const auto caption = [](const std::string& methods) {
        const auto figure = short_drift(100, {"series.projected=[]", "series.methods=" + methods});
        const auto page = page_of(figure);
        EXPECT_EQ(page.captions.size(), 1u);
        return page.captions.front();
    };
    EXPECT_EQ(
        caption("[\"euler\", \"rk4\", \"rattle6\"]"),
        "The error of the energy stays bounded for 100 s with rattle6; ∝ tells how the others grow, a dot marks a "
        "failed run.");
    EXPECT_EQ(caption("[\"gauss4\"]"), "The error of the energy stays bounded for 100 s with gauss4.");
    EXPECT_EQ(caption("[\"rk4\"]"), "No method keeps the error of the energy bounded; ∝ tells how the others grow.");
}

}  // namespace doppel::drift_test

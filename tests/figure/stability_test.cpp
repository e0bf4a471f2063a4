#include "analysis/stability.hpp"

#include "figure/support.hpp"
#include "output/golden.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace stability_test {

/// One row at an angle so small that linear theory holds while the energy grows a hundredfold.
std::vector<std::string> small_angle(const std::string& method, double from, double to, int columns) {
    return {fmt::format("stability.methods=[\"{}\"]", method),
            "stability.rows=1",
            "stability.to=0.2",
            fmt::format("stability.columns={}", columns),
            fmt::format("stability.step_from_s={}", from),
            fmt::format("stability.step_to_s={}", to),
            "stability.duration_s=40"};
}

double limit_of(const std::string& method) {
    Pendulum<double> p{.angle = {radians(0.1), 0}};
    return step_limit(method, small_oscillations(p), 40, blow_up).value();
}

TEST(Stability, RespectsTheLinearLimit) {
    for (const std::string method : {"semi-implicit-euler", "rk4", "adams", "rattle", "rattle6"}) {
        const double limit = limit_of(method);
        // rattle6 is stable again from 1.15 to 1.31 of its limit
        const auto table = table_of(figure_of("stability", small_angle(method, 0.8 * limit, 1.13 * limit, 24)));
        ASSERT_EQ(table.rows.size(), 24u);
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
    // the limits themselves: z = 2 and 2 √2 of ω = 5.7844/s, a little more after a time that is short
    EXPECT_NEAR(limit_of("rattle") * 5.7844, 2, 0.001);               // measured 0.0001
    EXPECT_NEAR(limit_of("rk4") * 5.7844, 2 * std::sqrt(2.0), 0.02);  // measured 0.013
}

TEST(Stability, SeesTheIslandsBeyondIt) {
    // trace of rattle6: stable from z = 2.9195 to 3.329
    const auto table = table_of(figure_of("stability", small_angle("rattle6", 2.96 / 5.7844, 3.28 / 5.7844, 6)));
    for (const auto& row : table.rows) EXPECT_FALSE(std::isnan(row[4])) << row[1] * 5.7844;
}

TEST(Stability, OfEulerGrowsByOnePlusZSquaredAStep) {
    const auto table = table_of(figure_of("stability", small_angle("euler", 5e-4, 3e-3, 5)));
    for (const auto& row : table.rows) {
        // half of the energy in either oscillation: ω² = 9.8 (2 ∓ √2)
        const double h = row[1], steps = 40 / h;
        const double grown = 0.5 * std::pow(1 + 9.8 * (2 - std::sqrt(2.0)) * h * h, steps) +
                             0.5 * std::pow(1 + 9.8 * (2 + std::sqrt(2.0)) * h * h, steps);
        EXPECT_NEAR((row[4] + 1) / grown, 1, 3e-4) << h;  // measured 6e-5
    }
}

TEST(Stability, OverTheMassRatioFollowsItsFrequency) {
    const auto table = table_of(figure_of(
        "stability-mass", {"stability.methods=[\"rattle\"]", "stability.rows=5", "stability.columns=40",
                           "stability.duration_s=40", "stability.step_from_s=0.03", "system.angle_deg=[0.05, 0]"}));
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
    const auto figure = figure_of("stability", {"stability.methods=[\"euler\"]", "stability.rows=2",
                                                "stability.columns=50", "stability.duration_s=1"});
    for (const auto& row : table_of(figure).rows) {
        const double steps = 1 / row[1];
        EXPECT_NEAR(steps, std::round(steps), 3e-13);  // measured 5.7e-14
    }
    const auto table = table_of(figure);
    const double ratio = std::pow(500.0, 1 / 50.0);
    for (std::size_t column = 0; column < 40; ++column) {
        const double asked = 0.002 * std::pow(ratio, static_cast<double>(column) + 0.5);
        EXPECT_NEAR(table.rows[2 * column][1] / asked, 1, std::max(0.006, asked / 2)) << asked;
    }
}

TEST(Stability, IsTheSameForAnyJobsAndFromTheResolvedPreset) {
    for (const char* name : {"stability", "stability-mass"}) {
        const auto figure = figure_of(name, {"stability.rows=4", "stability.columns=5", "stability.duration_s=2"});
        const auto expected = table_text(figure, computed(figure, 1));
        EXPECT_EQ(table_text(figure, computed(figure, 3)), expected);
        const auto again = read_figure({figure.name, "resolved.toml", figure.resolved()});
        EXPECT_EQ(again.resolved(), figure.resolved());
        EXPECT_EQ(table_text(again, computed(again)), expected);
        EXPECT_EQ(figure.experiment->trials(), 12u * 5);
    }
}

TEST(Stability, SaysWhatAPresetGotWrong) {
    const auto message = [](const std::string& lines, const std::string& system = "") {
        try {
            figure_from("[scene]\nkind = \"stability\"\n[system]\nangle_deg = [90, 0]\n" + system + "[stability]\n" +
                        lines + "\n");
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::bad_input);
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const std::string at = "presets/x.toml:6:";
    for (const auto& [lines, words] : std::vector<std::pair<std::string, std::string>>{
             {"methods = [\"eular\"]", "[stability] methods must be names of methods (doppel list methods); \"eular\""},
             {"methods = []", "[stability] methods must name at least one"},
             {"methods = [\"rk4\", \"rk4\"]", "methods must differ; \"rk4\""},
             {"model = \"angles\"\nmethods = [\"rattle\"]", "methods must serve model = \"angles\"; \"rattle\""},
             {"from = -1", "[stability] from must be at least 0; it is -1"},
             {"to = 181", "[stability] to must be more than from = 0 and at most 180; it is 181"},
             {"parameter = \"mass_ratio\"\nfrom = 0", "from must be > 0; it is 0"},
             {"parameter = \"lenght\"", "parameter"},
             {"step_to_s = 20", "step_to_s must be at most duration_s = 10; it is 20"},
             {"step_from_s = 2", "step_to_s must be more than step_from_s = 2; it is 1"},
             {"step_from_s = 1e-9", "step_from_s must leave at most 1"},
             {"tolerance_from = 1e-17", "tolerance_from must be at least 1e-15; it is 1e-17"},
             {"methods = [\"rk4\"]\ntolerance_from = 1e-9", "tolerance_from is for methods that go by a tolerance"},
             {"methods = [\"taylor\"]\nstep_from_s = 0.1", "step_from_s is for methods of fixed step"},
             {"rows = 0", "rows"},
             {"row = 3", "did you mean \"rows\""}})
        EXPECT_NE(message(lines).find(words), std::string::npos) << lines << ": " << message(lines);
    EXPECT_TRUE(message("methods = [\"eular\"]").starts_with(at)) << message("methods = [\"eular\"]");
    EXPECT_NE(message("", "gravity_m_per_s2 = 0\n").find("gravity_m_per_s2 must be > 0"), std::string::npos);
}

TEST(Stability, NeedsEnergyToCompareWith) {
    try {
        figure_of("stability-mass", {"system.angle_deg=[0, 0]"});
        FAIL() << "accepted";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("hangs at rest, without energy"), std::string::npos) << error.what();
    }
}

TEST(Stability, SharesItsAxes) {
    const auto page_of = [](const std::string& methods) {
        const auto figure = figure_of("stability", {"stability.rows=2", "stability.columns=2", "stability.duration_s=1",
                                                    "stability.methods=" + methods});
        Figure page;
        figure.experiment->draw(computed(figure), page);
        return page;
    };
    // nine of fixed step and three by tolerance: rows of three, each of one sort
    const auto all = page_of(
        "[\"euler\", \"semi-implicit-euler\", \"midpoint\", \"rk4\", \"adams\", \"gauss4\", "
        "\"gauss6\", \"rattle\", \"rattle6\", \"dopri5\", \"dop853\", \"taylor\"]");
    EXPECT_TRUE(all.shares_axes);
    EXPECT_EQ(all.columns, 3);
    ASSERT_EQ(all.panels.size(), 12u);
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(all.panels[i].x, all.panels[i < 9 ? 0 : 9].x) << i;
        EXPECT_EQ(all.panels[i].y, all.panels[0].y) << i;
        for (const auto& rule : all.panels[i].rules) EXPECT_EQ(rule.label, "");  // no words on the maps
    }
    EXPECT_NE(all.panels[0].x, all.panels[9].x);
    EXPECT_TRUE(all.panels[3].note.starts_with("limit 0."));  // of rk4
    EXPECT_EQ(all.panels[6].note, "");                        // Gauss collocation has none
    EXPECT_EQ(page_of("[\"rk4\", \"taylor\"]").columns, 0);
}

/// Steps, times and angles at which nothing is chaotic yet.
TEST(GoldenFigureOfStability, IsAsItWas) {
    const auto figure =
        figure_of("stability", {"stability.to=30", "stability.rows=18", "stability.columns=24",
                                "stability.duration_s=2", "stability.step_from_s=0.01", "stability.step_to_s=0.7",
                                "stability.methods=[\"euler\", \"semi-implicit-euler\", \"rk4\", \"rattle6\"]",
                                "chart.size=[960, 540]", "chart.scale=0.5"});
    test::expect_golden("figure-stability", picture_of(compose_figure(figure, computed(figure))));
}

}  // namespace stability_test
}  // namespace doppel

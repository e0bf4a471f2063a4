#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::study_test {

// The figures of the study, compared with an independent program to the digits given (Kao 2022, re-run).

FigurePreset narrowed(const std::string& preset, int from, int to, int step, std::vector<std::string> more = {}) {
    more.push_back(fmt::format("grid.x.from={}", from));
    more.push_back(fmt::format("grid.x.to={}", to));
    more.push_back(fmt::format("grid.x.step={}", step));
    return figure_of(preset, more);
}

using Values = std::vector<std::pair<double, double>>;

void expect_averages(const FigurePreset& figure, const Values& values) {
    const auto table = table_of(figure);
    EXPECT_EQ(static_cast<double>(table.rows.size()), units_of(figure));
    for (const auto& [parameter, expected] : values)
        EXPECT_NEAR(table.at(parameter, 1), expected, 6e-5) << figure.name << " at " << parameter;
}

TEST(Study, SweepsOverTheAngle) {
    expect_averages(narrowed("fig2-right", 0, 40, 10),
                    {{0, 0.7923}, {10, 1.2624}, {20, 2.2050}, {30, 2.7880}, {40, 2.9647}});
    expect_averages(narrowed("fig4-right", 10, 30, 10), {{10, 1.2635}, {20, 2.2062}, {30, 2.7888}});
    expect_averages(narrowed("fig8", 0, 32, 4), {{0, 0.8160}, {8, 1.3063}, {20, 2.6548}, {32, 3.0262}});
}

TEST(Study, SweepsOverAngleForAMassDifference) {
    expect_averages(narrowed("fig3-left", 4, 32, 4), {{4, 1.0294}, {20, 2.4862}, {32, 2.8891}});
    // both formulations agree where the motion is regular
    const auto angles = table_of(narrowed("fig3-left", 4, 28, 8)),
               particles = table_of(narrowed("fig5-left", 4, 28, 8));
    for (std::size_t i = 0; i < angles.rows.size(); ++i)
        EXPECT_NEAR(angles.rows[i][1], particles.rows[i][1], 6e-4) << angles.rows[i][0];  // measured 3.1e-4
}

TEST(Study, SweepsOverTheMassRatio) {
    const auto figure = figure_of("fig3-right", {"grid.x.from=0.5", "grid.x.to=0.57", "grid.x.step=0.01",
                                                 "scene.duration_s=2", "system.angle_deg=[20, 0]"});
    const auto table = table_of(figure);
    EXPECT_EQ(table.columns, (std::vector<std::string>{"mass_ratio", "average_log_ratio"}));
    ASSERT_EQ(table.rows.size(), 8u);
    EXPECT_EQ(table.rows[7][0], 0.57);  // 0.5 + 7 · 0.01 in double is not 0.57
    // one point of it as a separate pair
    const auto alone = figure_of("fig3-left", {"grid.x.from=20", "grid.x.to=20", "scene.duration_s=2",
                                               "a.mass_kg=[0.52, 1]", "b.mass_kg=[0.53, 1]"});
    EXPECT_EQ(table.rows[2][1], table_of(alone).rows[0][1]);
}

TEST(Study, HasItsWholeRangeInThePresets) {
    for (const char* name : {"fig2-right", "fig3-left", "fig4-right", "fig5-left", "fig8"})
        EXPECT_EQ(units_of(figure_of(name)), 181) << name;
    for (const char* name : {"fig3-right", "fig5-right"}) EXPECT_EQ(units_of(figure_of(name)), 200) << name;
}

TEST(Study, ColumnsAreTheDocumentedOnes) {
    const std::vector<std::pair<const char*, const char*>> tables{
        {"fig2-left", "sample,time_s,log_ratio"},
        {"fig2-right", "theta1_deg,average_log_ratio"},
        {"fig3-left", "theta1_deg,average_log_ratio"},
        {"fig3-right", "mass_ratio,average_log_ratio"},
        {"fig4-left", "sample,time_s,log_ratio"},
        {"fig4-right", "theta1_deg,average_log_ratio"},
        {"fig5-left", "theta1_deg,average_log_ratio"},
        {"fig5-right", "mass_ratio,average_log_ratio"},
        {"fig6", "sample,time_s,distance_45,distance_50"},
        {"fig7", "sample,time_s,distance"},
        {"fig8", "theta1_deg,average_log_ratio"},
        {"droplet", "sample,time_s,distance_79_79,distance_90_90"},
        {"certified", "sample,time_s,radius_double,radius_quad,radius_256_bits,distance"}};
    for (const auto& [name, columns] : tables) EXPECT_EQ(header_line(figure_of(name)), columns) << name;
    const auto exponents = header_line(figure_of("fig2-right", {"grid.right=\"exponent\""}));
    EXPECT_EQ(exponents.rfind("theta1_deg,average_log_ratio,exponent_per_s", 0), 0u) << exponents;
}

TEST(Study, PairOverTime) {
    // its list begins with sample 1: entry n, counted from 0, is sample n + 1
    const auto table = table_of(figure_of("fig2-left", {"scene.duration_s=9"}));
    EXPECT_EQ(table.rows.size(), 9u * 120 + 1);
    for (const auto& [sample, expected, slack] :
         {std::tuple{101.0, 0.941, 6e-4}, {501.0, 1.884, 2e-3}, {1001.0, 3.38, 6e-3}})
        EXPECT_NEAR(table.at(sample, 2), expected, slack) << sample;  // measured 0.941, 1.885, 3.384
    EXPECT_EQ(table.at(0, 2), 0);
    EXPECT_EQ(table.at(120, 1), 1);
    EXPECT_EQ(figure_of("fig2-left").experiment->trials(), 1u);
}

TEST(Study, PairsOverAllSamples) {
    const auto samples = [](const char* name) {
        const auto resolved = figure_of(name).resolved();
        return resolved.substr(resolved.find("duration_s"), resolved.find("\nsample_hz") - resolved.find("duration_s"));
    };
    EXPECT_EQ(samples("fig2-left"), "duration_s = \"80/3\"");  // 3200 at 120 Hz
    EXPECT_EQ(samples("fig4-left"), "duration_s = \"80/3\"");
    EXPECT_EQ(table_of(figure_of("fig2-left")).rows.size(), 3201u);
    EXPECT_EQ(table_of(figure_of("fig6")).rows.size(), 4501u);
}

TEST(Study, FormulationsDiverge) {
    const auto table = table_of(figure_of("fig6"));
    for (const auto& [column, largest, at] : {std::tuple{2u, 0.633, 4370L}, {3u, 1.044, 4350L}}) {
        const auto maximum = std::max_element(table.rows.begin(), table.rows.end(),
                                              [&](const auto& a, const auto& b) { return a[column] < b[column]; });
        EXPECT_NEAR((*maximum)[column], largest, 6e-4);
        EXPECT_NEAR(static_cast<double>(maximum - table.rows.begin()), static_cast<double>(at), 5);
    }
}

TEST(Study, FormulationsDivergeByTruncation) {
    // erratum 6: a quarter of the step, a quarter of the distance
    const auto table = table_of(figure_of("fig6", {"system.step_s=\"1/120000\"", "scene.duration_s=37"}));
    double largest = 0;
    for (const auto& row : table.rows) largest = std::max(largest, row[3]);
    EXPECT_NEAR(largest, 0.242, 6e-4);
}

// The films' loop supports any model, method and precision; batches support fixed steps in double. Both give one sweep.

void expect_same_sweep(const std::vector<std::string>& one, const std::vector<std::string>& other, double slack) {
    const auto sweep = [](std::vector<std::string> sets) {
        sets.emplace_back("scene.duration_s=2");
        return table_of(narrowed("fig2-right", 10, 40, 10, sets));
    };
    const auto a = sweep(one), b = sweep(other);
    ASSERT_EQ(a.rows.size(), b.rows.size());
    for (std::size_t i = 0; i < a.rows.size(); ++i)
        EXPECT_NEAR(a.rows[i][1], b.rows[i][1], slack) << other.front() << " at " << a.rows[i][0];
}

TEST(Sweep, IsTheSameByEveryPath) {
    const std::string rk4 = "system.integrator=\"rk4\"", dop853 = "system.integrator=\"dop853\"";
    expect_same_sweep({rk4}, {dop853, "system.tolerance=1e-13"}, 1e-9);  // measured 1.1e-10
    const std::string taylor = "system.integrator=\"taylor\"", finest = "system.tolerance=1e-13";
    expect_same_sweep({taylor, finest}, {dop853, finest}, 1e-9);
    expect_same_sweep({"system.accuracy=1e-9"}, {dop853, finest}, 1e-9);
    const std::string three = "system.links=3", released = "system.angle_deg=[0, 20, 40]";
    expect_same_sweep({taylor, finest, three, released}, {dop853, finest, three, released}, 1e-9);
    expect_same_sweep({"system.model=\"constraints\""}, {"system.model=\"mechanism\""}, 3e-9);  // measured 3.8e-10
    expect_same_sweep({"scene.sample_hz=100", "system.step_s=\"1/1000\""},
                      {"scene.sample_hz=100", "system.step_s=\"1/1000\"", "system.precision=\"quad\""},
                      3e-10);  // measured 2.4e-11
}

TEST(Sweep, GoesOverEveryParameter) {
    const auto theta2 =
        table_of(narrowed("fig2-right", 10, 30, 10, {"grid.x.key=\"theta2_deg\"", "scene.duration_s=1"}));
    EXPECT_EQ(theta2.columns.front(), "theta2_deg");
    const auto length = table_of(
        figure_of("fig2-right", {"grid.x.key=\"length_ratio\"", "grid.x.from=0.5", "grid.x.to=1.5", "grid.x.step=0.5",
                                 "grid.difference=0.01", "scene.duration_s=1", "system.angle_deg=[20, 10]"}));
    EXPECT_EQ(length.columns.front(), "length_ratio");
    for (const auto* table : {&theta2, &length}) {
        ASSERT_EQ(table->rows.size(), 3u);
        EXPECT_TRUE(std::isfinite(table->rows[0][1]));
        EXPECT_NE(table->rows[0][1], table->rows[1][1]);
    }
    // a pendulum of one link works as well
    const auto lone =
        figure_of("fig2-right", {"system.links=1", "system.angle_deg=[0]", "grid.x.to=2", "scene.duration_s=1"});
    EXPECT_EQ(table_of(lone).rows.size(), 3u);
}

TEST(Sweep, EndsAtItsLimits) {
    for (const auto& [to, step, rows] :
         {std::tuple{"0.3", "0.1", 4}, {"1", "0.1", 11}, {"0", "1", 1}, {"2", "0.01", 201}}) {
        const auto figure =
            figure_of("fig2-right", {fmt::format("grid.x.to={}", to), fmt::format("grid.x.step={}", step)});
        EXPECT_EQ(units_of(figure), rows) << to << " by " << step;
    }
}

TEST(Sweep, LeavesOutEqualPairs) {
    // at 1 kg the pair is identical: there is no ratio to take a logarithm of, and no run failed
    const auto figure = figure_of("fig2-right", {"grid.x.key=\"b.mass_kg[0]\"", "grid.difference=0", "grid.x.from=1",
                                                 "grid.x.to=2", "system.angle_deg=[90, 0]", "scene.duration_s=1"});
    const auto table = table_of(figure);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_TRUE(std::isnan(table.rows[0][1]));
    EXPECT_TRUE(std::isfinite(table.rows[1][1]));
    EXPECT_EQ(std::ranges::count(page_of(figure).captions, "Not drawn: run failed."), 0);
}

TEST(Sweep, ExponentDistinguishesRegularFromChaotic) {
    const auto table = table_of(figure_of("fig2-right", {"grid.right=\"exponent\"", "grid.exponent_duration_s=200",
                                                         "grid.x.step=60", "scene.duration_s=1"}));
    ASSERT_EQ(table.rows.size(), 4u);
    ASSERT_GE(table.columns.size(), 4u);
    EXPECT_EQ(table.columns[2], "exponent_per_s");
    EXPECT_EQ(table.at(0, 2), 0);                       // it hangs at rest
    EXPECT_LT(table.at(60, 2), 2 * table.at(60, 3));    // measured 0.011 ± 0.020
    EXPECT_GT(table.at(120, 2), 5 * table.at(120, 3));  // measured 0.84 ± 0.08
    // upper link upright, lower hanging: det(K + s² M) = 0 has the root s⁴ = 2 g²
    EXPECT_NEAR(table.at(180, 2), std::sqrt(std::sqrt(2.0) * 9.8), 3e-15);  // measured 4e-16
}

}  // namespace doppel::study_test

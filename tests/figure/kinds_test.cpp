#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::kinds_test {

// What the figures must show, independent of their layout.

TEST(Convergence, FallsByThePowerOfTheOrder) {
    const auto table = table_of(
        figure_of("why-they-part", {"scene.duration_s=0.5", "grid.color.values=[\"euler\", \"midpoint\", \"rk4\"]",
                                    "grid.x.points=6", "grid.x.to=0.000260416666666666666"}));
    int seen = 0;
    for (std::size_t i = 1; i < table.rows.size(); ++i) {
        const auto &coarse = table.rows[i - 1], &fine = table.rows[i];
        const bool is_finest = i + 1 == table.rows.size() || table.words[i][0] != table.words[i + 1][0];
        if (table.words[i][1] != "quad" || !is_finest) continue;
        const double slope = std::log(coarse[3] / fine[3]) / std::log(coarse[2] / fine[2]);
        const std::map<std::string, double> orders{{"euler", 1}, {"midpoint", 2}, {"rk4", 4}};
        EXPECT_NEAR(slope, orders.at(table.words[i][0]), 0.01) << table.words[i][0];  // measured 0.0015
        ++seen;
    }
    EXPECT_EQ(seen, 3);
}

TEST(Convergence, ListsEverySetting) {
    const auto table =
        table_of(figure_of("why-they-part", {"scene.duration_s=0.1", "grid.color.values=[\"euler\", \"dop853\"]",
                                             "grid.x.points=4", "grid.x.to=0.00104166666666666666",
                                             "grid.x.tolerance_to=1e-20", "grid.x.tolerance_points=18"}));
    EXPECT_EQ(table.columns, (std::vector<std::string>{"method", "precision", "step_s", "distance", "steps"}));
    ASSERT_EQ(table.rows.size(), 4u + 12 + 4 + 18);  // double precision has no tolerance below 1e-14
    for (std::size_t i = 0; i + 1 < 4; ++i) EXPECT_DOUBLE_EQ(table.rows[i][2], 2 * table.rows[i + 1][2]);
    EXPECT_DOUBLE_EQ(table.rows[0][2], 1.0 / 120);
}

TEST(Spectrum, ComesInPairsThatSumToZero) {
    const auto table = table_of(figure_of("lyapunov-spectrum", {"series.duration_s=100", "series.samples=20"}));
    EXPECT_EQ(table.columns.front(), "time_s");
    EXPECT_EQ(table.columns.back(), "sum_per_s");
    ASSERT_EQ(table.columns.size(), 6u);
    ASSERT_EQ(table.rows.size(), 20u);
    const auto& last = table.rows.back();
    EXPECT_DOUBLE_EQ(last[0], 100);
    EXPECT_NEAR(last[1] + last[2] + last[3] + last[4], last[5], 1e-15);  // measured 0
    EXPECT_NEAR(last[5], 0, 1e-11);                                      // measured 2.6e-12
    EXPECT_NEAR(last[1], -last[4], 0.05);                                // measured 0.01; they converge as 1/t
    EXPECT_GT(last[1], 0.5);                                             // 90°/90° is chaotic
}

TEST(Spectrum, OfADrivenPendulumSumsToFrictionOverInertia) {
    const auto figure = figure_of("driven-spectrum", {"series.duration_s=200", "series.samples=20"});
    const auto table = table_of(figure);
    ASSERT_EQ(table.columns.size(), 4u);  // no column of the time, none of the work
    for (const auto& row : table.rows) EXPECT_NEAR(row[3], -1.5652475842498528, 3e-11);  // measured 4e-12
    EXPECT_GT(table.rows.back()[1], 0.2);
    // with friction the exponents form no pairs
    EXPECT_EQ(page_of(figure).captions.at(0).find("pairs are"), std::string::npos);
}

TEST(Sweep, FindsExponentsOfDrivenPendulums) {
    // the smallest exponent is the rate at which one driven link loses its initial state, b/2J
    const auto table = table_of(figure_from(R"(
[scene]
kind = "grid"
duration_s = 1
[system]
links = 1
angle_deg = 10
rod_mass_kg = 0.3
joint_viscous_N_m_s = 1.1
[[system.torque]]
name = "motor"
amplitude_N_m = 1
frequency_hz = 0.3
[grid]
quantity = "exponent"
exponent_duration_s = 200
[grid.x]
key = "system.torque.motor.amplitude_N_m"
from = 0.5
to = 2.5
points = 3
)"));
    ASSERT_EQ(table.rows.size(), 3u);
    for (const auto& row : table.rows) EXPECT_NEAR(row[1], -0.5, 0.02) << row[0];
}

TEST(Bifurcation, PeriodsDoubleWhereTheTextbookSays) {
    // of θ″ + θ′/2 + sinθ = γ cos(2τ/3): one period at 1.35, two at 1.45, four at 1.47, none at 1.15 and 1.5
    // Source  Baker & Gollub, Chaotic Dynamics, §3.3
    const double weight = 9.8 * 0.4413;
    for (const auto& [strength, periods] : {std::pair{1.35, 1}, {1.45, 2}, {1.47, 4}, {1.15, 0}, {1.5, 0}}) {
        const auto table =
            table_of(figure_of("bifurcation", {fmt::format("grid.x.from={:.6f}", strength * weight),
                                               fmt::format("grid.x.to={:.6f}", strength * weight + 1e-5),
                                               "grid.x.points=2", "grid.transient_periods=300", "grid.periods=64"}));
        std::vector<double> rates;
        for (std::size_t i = 0; i < 64; ++i) rates.push_back(table.rows[i][3]);
        std::sort(rates.begin(), rates.end());
        int distinct = 1;
        for (std::size_t i = 1; i < rates.size(); ++i) distinct += rates[i] - rates[i - 1] > 1e-3;
        if (periods > 0) {
            EXPECT_EQ(distinct, periods) << strength;
        } else {
            EXPECT_GT(distinct, 32) << strength;
        }
    }
}

TEST(Map, TheVibratingPivotIsStableUpToItsTheoreticalEdge) {
    // a row of amplitudes on both sides of Mathieu's stability limit at 4 Hz, 0.177 m
    const auto found =
        table_of(figure_of("kapitza-map", {"grid.x.from=3.99", "grid.x.to=4.01", "grid.x.points=2", "grid.y.from=0.167",
                                           "grid.y.to=0.187", "grid.y.points=4", "scene.duration_s=15"}));
    ASSERT_EQ(found.rows.size(), 8u);
    for (const auto& row : found.rows) {
        if (row[1] < 0.177) {
            EXPECT_GT(row[2], 90) << row[1];
        } else {
            EXPECT_LT(row[2], 30) << row[1];
        }
    }
}

/// The orbits of a section at one energy: indices of the grey ones, hues of the others, and texts.
struct SectionPage {
    std::vector<std::size_t> grey;
    std::vector<int> hues;  // of the orbits that are not grey
    std::string caption, note;
};
SectionPage section_page(const std::string& energy_J, int orbits, const std::string& gravity = "9.8",
                         const std::string& seconds = "2000") {
    const auto figure =
        figure_of("poincare", {fmt::format("section.energy_J=[{}]", energy_J), fmt::format("section.orbits={}", orbits),
                               "section.crossings=4", "section.exponent_duration_s=" + seconds,
                               "system.gravity_m_per_s2=" + gravity});
    const auto page = page_of(figure);
    SectionPage made{.caption = page.captions.front(), .note = page.panels[0].note};
    const auto& curves = page.panels[0].curves;
    for (std::size_t i = 0; i < curves.size(); ++i)
        if (curves[i].quiet)
            made.grey.push_back(i);
        else
            made.hues.push_back(curves[i].hue);
    return made;
}

TEST(Section, DistinguishesRegularFromChaoticOrbits) {
    using Numbers = std::vector<std::size_t>;
    // almost without gravity, angular momentum is also conserved: every orbit is regular. Only the first one is
    // driven along its separatrix by round-off
    const auto free = section_page("39.2", 12, "1e-9");
    EXPECT_EQ(free.grey, Numbers{0});
    EXPECT_EQ(free.note, "11 of 12 regular");
    EXPECT_NE(free.caption.find("(colours repeat): the largest Lyapunov exponent of 2000 s"), std::string::npos);
    // at 4 m g l above hanging, no orbit is regular: exponents of 1.2 … 1.3 1/s
    const auto wild = section_page("39.2", 4);
    EXPECT_EQ(wild.grey, (Numbers{0, 1, 2, 3}));
    EXPECT_NE(wild.caption.find("(a colour each)"), std::string::npos);
    // between the two, some are chaotic, at 0.12 … 0.15 1/s, the others are below 0.0005 1/s. One stays near an island
    // for 1000 s
    const auto mixed = section_page("14.7", 12, "9.8", "10000");
    EXPECT_EQ(mixed.grey, (Numbers{1, 2, 6, 9, 10, 11}));
    EXPECT_EQ(mixed.hues, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(Section, HasPointsThatTheEnergyAllows) {
    const auto table = table_of(figure_of("poincare", {"section.energy_J=[9.8, 20]", "section.orbits=3",
                                                       "section.crossings=10", "section.exponent_duration_s=100"}));
    EXPECT_EQ(table.columns, (std::vector<std::string>{"energy_J", "orbit", "exponent_per_s", "regular", "time_s",
                                                       "theta2_rad", "p2_N_m_s"}));
    EXPECT_EQ(table.rows.size(), 2u * 3 * 10);
    double time = 0, orbit = -1;
    for (const auto& row : table.rows) {
        // with θ1 = 0 and ω1 free: E ≥ p2² / (2 m2 l2²) + m2 g l2 (1 − cosθ2)
        EXPECT_LE(row[6] * row[6] / 2 + 9.8 * (1 - std::cos(row[5])), row[0] * (1 + 1e-9));
        EXPECT_TRUE(row[1] != orbit || row[4] > time) << row[4];
        time = row[4];
        orbit = row[1];
    }
}

/// The subtitle describes the system of the figure, which may differ from the preset's.
TEST(Subtitle, IsOfTheSystem) {
    const auto subtitle = [](const std::string& preset, const std::vector<std::string>& sets) {
        return figure_of(preset, sets).subtitle;
    };
    EXPECT_EQ(
        subtitle("poincare", {"system.mass_kg=[1, 2.5]", "system.length_m=0.5"}),
        "Poincaré sections θ₁ = 0, ω₁ > 0 of a double pendulum, links of 0.5 m and 1/2.5 kg, g = 9.8 m/s²; energies "
        "above hanging at rest");
    EXPECT_EQ(subtitle("lyapunov-spectrum", {"system.links=3", "system.angle_deg=[10, 20, 30.5]"}),
              "a triple pendulum released at rest from 10°/20°/30.5°, links of 1 m and 1 kg, g = 9.8 m/s²; tangent "
              "equations by Dormand–Prince 8(5,3)");
    EXPECT_EQ(
        subtitle("drift",
                 {"system.angle_deg=[40, 5]", "system.omega_deg_per_s=[0, -90]", "series.evaluations_per_s=250"}),
        "a double pendulum released from 40°/5° at 0/-90 °/s, links of 1 m and 1 kg, g = 9.8 m/s²; every method at "
        "some 250 evaluations a second of motion");
    EXPECT_EQ(subtitle("links", {"system.angle_deg=[120]", "system.mass_kg=[2]", "grid.exponent_duration_s=30"}),
              "chains in angles, released from 120°; tangent equations by Dormand–Prince 8(5,3)");
}

TEST(Subtitle, OfASeriesIsOfWhatItsPairsShare) {
    const std::string text =
        "[scene]\nkind = \"series\"\n[system]\nangle_deg = [100, 100]\nintegrator = \"dop853\"\n"
        "[b]\nangle_deg = [100.1, 100]\n";
    EXPECT_EQ(figure_from(text).subtitle,
              "two links in angles, θ₂ = 100°, θ₁ = 100° against θ₁ = 100.1°; Dormand–Prince 8(5,3), tolerance 10⁻¹²");
    EXPECT_EQ(figure_from(text + "[[curve]]\ncolumn = \"one\"\n[[curve]]\ncolumn = \"two\"\n"
                                 "system.mass_kg = [3, 1]\nsystem.integrator = \"taylor\"\n")
                  .subtitle,
              "two links, θ₂ = 100°, θ₁ = 100° against θ₁ = 100.1°");
}

TEST(FlipMap, ForbidsWhatTheEnergyForbids) {
    const auto figure = figure_of("flip-map", {"grid.x.points=40", "grid.y.points=40", "scene.duration_s=5"});
    const auto table = table_of(figure);
    ASSERT_EQ(table.rows.size(), 1600u);
    int flipped = 0;
    for (const auto& row : table.rows) {
        // one rod upright, the other hanging: E ≥ −m2 g l2. For equal links: 3 − 2 = 2 cosθ1 + cosθ2
        const bool forbidden = 2 * std::cos(row[0] * pi / 180) + std::cos(row[1] * pi / 180) > 1;
        EXPECT_TRUE(!forbidden || std::isnan(row[2])) << row[0] << " " << row[1];
        flipped += !std::isnan(row[2]);
    }
    EXPECT_GT(flipped, 300);
}

TEST(FlipMap, LeavesFailedCellsEmpty) {
    // such strong gravity that some motions need steps below 1e-9 s
    const auto figure =
        figure_of("flip-map", {"system.gravity_m_per_s2=3e15", "grid.x.points=16", "grid.y.points=16",
                               "scene.duration_s=1e-6", "scene.sample_hz=1000000", "system.step_s=\"1/1000000\""});
    const auto trials = computed(figure);
    Figure page;
    figure.experiment->draw(trials, page);
    EXPECT_NE(page.captions.back().find("of the releases failed"), std::string::npos) << page.captions.back();
    EXPECT_TRUE(page.panels.back().map->none_label.ends_with(", or failed")) << page.panels.back().map->none_label;
    EXPECT_TRUE(std::ranges::any_of(page.panels.back().map->values, [](float time) { return std::isfinite(time); }));
}

TEST(Curves, ShowAnyColumnOfAFilmOfSeveralRuns) {
    const std::string text = R"(
[scene]
kind = "series"
duration_s = 1
[system]
angle_deg = [90, 90]
[series]
film_column = "a_theta2_rad"
[[curve]]
column = "calm"
system.angle_deg = [30, 30]
[[curve]]
column = "wild"
[[curve]]
column = "kinetic"
film_column = "b_kinetic_J"
)";
    const auto figure = figure_from(text);
    const auto table = table_of(figure);
    EXPECT_EQ(table.columns, (std::vector<std::string>{"sample", "time_s", "calm", "wild", "kinetic"}));
    const auto scene =
        make_scene(read_preset({"x", "x.toml", "[scene]\nduration_s = 1\n[system]\nangle_deg = [90, 90]\n"}));
    PairRun run(scene);
    for (const auto& row : table.rows) {
        const auto state = run.next(false);
        EXPECT_EQ(row[3], state.a.bobs[1].theta);
        EXPECT_EQ(row[4], state.b.kinetic_energy);
    }
    EXPECT_NEAR(table.rows[0][2], pi / 6, 1e-15);
    const auto page = page_of(figure);
    EXPECT_EQ(page.panels.at(0).y.label, "θ₂, rad (a); kinetic, J (b)");
    EXPECT_EQ(figure.subtitle, "two links in angles; explicit Euler, 1/30 000 s");
    // each column of the film's table is a number
    for (const auto& column : {"a_theta1_rad", "b_omega2_rad_per_s", "a_x1_m", "a_y2_m", "b_vx1_m_per_s",
                               "b_vy2_m_per_s", "a_energy_J", "a_energy_error", "b_length_error_m", "a_potential_J"})
        EXPECT_TRUE(std::isfinite(table_of(figure_from("[scene]\nkind = \"series\"\nduration_s = 0.1\n",
                                                       {fmt::format("series.film_column=\"{}\"", column)}))
                                      .rows.back()[2]))
            << column;
    expect_refused({"film_column", "must be one of a_theta1_rad", "\"a_theta3_rad\""},
                   [&] { figure_from(text, {"series.film_column=\"a_theta3_rad\""}); });
    expect_refused({":19:1: [[curve]] 4 film_column must be one of a_theta1_rad", "\"speed\""},
                   [&] { figure_from(text + "[[curve]]\ncolumn = \"d\"\n" + "film_column = \"speed\"\n"); });
}

TEST(Curves, CheckToleranceShowsUntilWhenTheyAgree) {
    const std::vector<std::string> short_run{"scene.duration_s=2", "system.integrator=\"dop853\"",
                                             "system.tolerance=1e-10", "series.check_tolerance=1e-12"};
    const auto figure = figure_of("fig2-left", short_run);
    const auto page = page_of(figure);
    EXPECT_EQ(page.captions.back(), "Converged: at tolerance 10⁻¹² the values are the same within 1 %: until 2.0 s.");
    EXPECT_EQ(header_line(figure_of("fig2-left", {"system.integrator=\"dop853\"", "system.tolerance=1e-10",
                                                  "series.check_tolerance=1e-12"})),
              "sample,time_s,log_ratio");
}

}  // namespace doppel::kinds_test

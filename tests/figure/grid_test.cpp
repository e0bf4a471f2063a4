#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::grid_test {

const std::string twins = R"(
[scene]
kind = "grid"
duration_s = 12
[system]
angle_deg = [120, 80]
[b]
angle_deg = [120.01, 80]
[grid.x]
key = "system.mass_kg[1]"
from = 0.5
to = 2
step = 0.5
)";

/// The pair of trial i as a film.
Scene film(double mass) {
    auto preset = read_preset({"x", "x.toml",
                               "[scene]\nduration_s = 12\n[system]\nangle_deg = [120, 80]\n"
                               "[b]\nangle_deg = [120.01, 80]\n"});
    preset.a.mass_kg[1] = preset.b.mass_kg[1] = Quad(mass);
    return make_scene(preset);
}

TEST(Grid, InLanesFindsWhatAFilmShows) {
    const auto distances = table_of(figure_from(twins, {"grid.quantity=\"distance_at_end\""})),
               partings = table_of(figure_from(twins, {"grid.quantity=\"parting_time\""})),
               errors = table_of(figure_from(twins, {"grid.quantity=\"energy_error\""}));
    EXPECT_EQ(distances.columns, (std::vector<std::string>{"system.mass_kg[1]", "distance_at_end"}));
    ASSERT_EQ(distances.rows.size(), 4u);
    long parted = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto scene = film(distances.rows[i][0]);
        PairRun run(scene);
        Divergence parting;
        double last = 0, worst = 0;
        for (long n = 0; n <= scene.samples; ++n) {
            const auto state = run.next(false);
            last = state.distance;
            parting.add(scene.time(n), last);
            worst = std::max(worst, std::abs(state.a.energy_change));
        }
        EXPECT_EQ(distances.rows[i][1], last) << i;
        EXPECT_NEAR(errors.rows[i][1], worst / scene.a.energy_unit, 1e-25) << i;  // the same
        parted += parting.since().has_value();
        if (parting.since()) {
            EXPECT_EQ(partings.rows[i][1], *parting.since()) << i;
        } else {
            EXPECT_TRUE(std::isnan(partings.rows[i][1])) << i;
        }
    }
    EXPECT_GT(parted, 0);
}

TEST(Grid, OneByOneFindsWhatLanesFind) {
    // a spring of almost no stiffness makes it a mechanism
    const std::string spring =
        "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\nstiffness_N_per_m = 1e-12\n";
    for (const char* quantity : {"flip_time", "energy_error", "divergence"}) {
        const std::vector<std::string> sets{fmt::format("grid.quantity=\"{}\"", quantity), "scene.duration_s=4",
                                            "system.integrator=\"rk4\""};
        const auto lanes = table_of(figure_from(twins, sets)), alone = table_of(figure_from(twins + spring, sets));
        for (std::size_t i = 0; i < lanes.rows.size(); ++i)
            if (std::isfinite(lanes.rows[i][1]) || std::isfinite(alone.rows[i][1])) {
                EXPECT_NEAR(lanes.rows[i][1], alone.rows[i][1], 1e-8) << quantity << ' ' << i;  // measured 1.8e-10
            }
    }
}

/// Flips are found by Taylor series, but not where an axis compares methods.
TEST(Grid, ComparesTheFlipsOfMethods) {
    const auto figure =
        figure_from(twins, {"scene.duration_s=6", "system.step_s=1/120", "grid.quantity=flip_time",
                            "system.angle_deg=[150, 150]", "grid.x.values=[1]", "grid.panel.key=system.integrator",
                            "grid.panel.values=[\"euler\", \"rk4\", \"taylor\"]"});
    const auto table = table_text(figure, computed(figure));
    const auto time_of = [&](const std::string& method) {
        const auto at = table.find(method + ",1,");
        EXPECT_NE(at, std::string::npos) << table;
        return std::stod(table.substr(at + method.size() + 3));
    };
    EXPECT_GT(std::abs(time_of("euler") - time_of("taylor")), 1e-2);
    EXPECT_NEAR(time_of("rk4"), time_of("taylor"), 1e-3);
}

TEST(Grid, FindsTheSameInAnyOrderOfItsValues) {
    // one link without friction and two with it: not all of them can be in lanes
    const auto of = [](const std::string& quantity, const std::string& values) {
        return table_of(figure_from(twins, {"scene.duration_s=3", "system.angle_deg=[150,150]",
                                            "b.angle_deg=[150.01,150]", "system.integrator=\"rk4\"",
                                            "grid.quantity=" + quantity, "grid.x.key=system.joint_viscous_N_m_s[0]",
                                            "grid.x.values=" + values, "system.joint_viscous_N_m_s=[0,0]"}))
            .rows;
    };
    for (const std::string quantity : {"greatest_distance", "energy_error", "flip_time"}) {
        const auto up = of(quantity, "[0,0.5,1]"), down = of(quantity, "[1,0.5,0]");
        for (std::size_t i = 0; i < up.size(); ++i)
            EXPECT_TRUE(up[i][1] == down[2 - i][1] || (std::isnan(up[i][1]) && std::isnan(down[2 - i][1])))
                << quantity << i << ": " << up[i][1] << ", " << down[2 - i][1];
        EXPECT_NE(up[0][1], up[1][1]) << quantity;
    }
}

TEST(Grid, OfACenterOfMassMovesIt) {
    const std::vector<std::string> sets{"scene.duration_s=1", "grid.quantity=greatest_distance",
                                        "grid.x.key=system.center_m", "grid.x.values=[0.2, 1]"};
    const auto rows = table_of(figure_from(twins, sets)).rows;
    EXPECT_GT(std::abs(rows[0][1] - rows[1][1]), 1e-6);
    auto given = sets;
    given.emplace_back("system.center_m=[1, 1]");
    EXPECT_EQ(table_of(figure_from(twins, given)).rows, rows);
}

TEST(Grid, TakesTheFrequencyOfAPivotWhoseAmplitudeIsSwept) {
    std::vector<std::string> sets{
        "scene.duration_s=1",   "grid.quantity=energy_error",         "grid.x.key=system.pivot.frequency_hz",
        "grid.x.values=[1, 2]", "grid.color.key=a.pivot.amplitude_m", "grid.color.values=[0, 0.1]"};
    const auto rows = table_of(figure_from(twins, sets)).rows;
    EXPECT_EQ(rows.at(0).back(), rows.at(1).back());
    EXPECT_NE(rows.at(2).back(), rows.at(3).back());
}

TEST(Grid, OfEqualRatiosHasItsEndsAndTheStepsThatAreTaken) {
    const auto table = table_of(figure_from(
        "[scene]\nkind = \"grid\"\nduration_s = 2\n[system]\nintegrator = \"rk4\"\nangle_deg = [60, 60]\n[grid]\n"
        "quantity = \"energy_error\"\n[grid.x]\nkey = \"system.step_s\"\nfrom = 0.0001\nto = 0.008\npoints = 9\n"
        "spacing = \"logarithmic\"\n"));
    ASSERT_EQ(table.rows.size(), 9u);
    EXPECT_EQ(table.rows[0][0], 1.0 / (120 * 83));
    EXPECT_EQ(table.rows[8][0], 1.0 / 120);
    // convergence of order 4
    const double slope = std::log(table.rows[8][1] / table.rows[5][1]) / std::log(table.rows[8][0] / table.rows[5][0]);
    EXPECT_NEAR(slope, 4, 0.1);  // measured 3.98
    const auto listed =
        table_of(figure_from("[scene]\nkind = \"grid\"\nduration_s = 1\n[system]\nintegrator = "
                             "\"rk4\"\n[grid]\nquantity = \"energy_error\"\n"
                             "[grid.x]\nkey = \"system.step_s\"\nvalues = [\"1/30000\", 0.001, \"1/120\"]\n"));
    ASSERT_EQ(listed.rows.size(), 3u);
    EXPECT_EQ(listed.rows[0][0], 1.0 / 30000);
    EXPECT_EQ(listed.rows[2][0], 1.0 / 120);
}

TEST(Grid, NamesTheMethodInItsSubtitle) {
    const auto subtitle = [](const std::string& quantity, const std::vector<std::string>& sets = {}) {
        auto all = sets;
        all.insert(all.end(),
                   {"grid.x.points=4", "grid.y.points=3", "scene.duration_s=1", "grid.quantity=\"" + quantity + "\""});
        return figure_of("parting-map", all).subtitle;
    };
    EXPECT_EQ(subtitle("divergence"), "two links in angles, θ₂ = 0, pair 0.001° apart; Runge–Kutta 4, 1/240 s");
    EXPECT_EQ(subtitle("energy_error"), "two links in angles, θ₂ = 0; Runge–Kutta 4, 1/240 s");
    EXPECT_EQ(subtitle("exponent"), "two links in angles, θ₂ = 0; tangent equations by Dormand–Prince 8(5,3)");
    EXPECT_EQ(subtitle("flip_time"), "two links in angles, θ₂ = 0; Taylor series, tolerance 1.0 × 10⁻⁸");
    // the subtitle omits the number that varies
    EXPECT_EQ(subtitle("energy_error",
                       {"grid.x.key=\"system.step_s\"", "grid.x.from=0.0001", "grid.x.to=0.002", "grid.difference=0"}),
              "two links in angles, 90°/0°; Runge–Kutta 4");
}

TEST(Grid, HasTheNumbersOfSweeps) {
    const auto map = table_of(figure_from(
        "[scene]\nkind = \"grid\"\nduration_s = 3\n[system]\nangle_deg = [0, 100]\n[grid]\ndifference = 0.01\n"
        "[grid.x]\nkey = \"system.angle_deg[0]\"\nfrom = 5\nto = 175\npoints = 17\n"
        "[grid.y]\nkey = \"mass_ratio\"\nfrom = 0.1\nto = 10\nspacing = \"logarithmic\"\npoints = 5\n"));
    ASSERT_EQ(map.rows.size(), 17u * 5);
    EXPECT_EQ(map.columns, (std::vector<std::string>{"system.angle_deg[0]", "mass_ratio", "average_log_ratio"}));
    const std::size_t row = 3;
    const double ratio = map.rows[row * 17][1];
    EXPECT_NEAR(ratio, std::pow(10, -1 + 2 * 3.5 / 5), 1e-14);
    const auto sweep = table_of(figure_from(fmt::format(
        "[scene]\nkind = \"grid\"\nduration_s = 3\n[system]\nangle_deg = [0, 100]\nmass_kg = [{:.17g}, 1]\n[grid]\n"
        "difference = 0.01\n[grid.x]\nfrom = 10\nto = 170\nstep = 10\n",
        ratio)));
    for (std::size_t i = 0; i < 17; ++i) {
        EXPECT_EQ(map.rows[row * 17 + i][0], sweep.rows[i][0]);
        EXPECT_NEAR(map.rows[row * 17 + i][2], sweep.rows[i][1], 1e-9) << i;  // the ratio is rounded
    }
}

/// A small flip map.
FigurePreset flips(int columns, int rows, const std::array<int, 4>& ends = {-180, 180, -180, 180}) {
    return figure_of("flip-map", {"scene.duration_s=8", fmt::format("grid.x.points={}", columns),
                                  fmt::format("grid.y.points={}", rows), fmt::format("grid.x.from={}", ends[0]),
                                  fmt::format("grid.x.to={}", ends[1]), fmt::format("grid.y.from={}", ends[2]),
                                  fmt::format("grid.y.to={}", ends[3])});
}

TEST(FlipMap, OfAPartHasTheCellsOfTheWhole) {
    const auto whole = table_of(flips(16, 16)), part = table_of(flips(8, 4, {0, 180, -90, 0}));
    ASSERT_EQ(part.rows.size(), 32u);
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t k = 0; k < 3; ++k) {
                const double one = part.rows[8 * r + c][k], other = whole.rows[16 * (r + 4) + c + 8][k];
                EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other))) << r << ' ' << c << ' ' << k;
            }
    // no release has enough energy to flip
    const auto still = table_of(flips(4, 4, {-1, 1, -1, 1}));
    for (const auto& row : still.rows) EXPECT_TRUE(std::isnan(row[2]));
}

/// A pair against the mass ratio, at three angles.
const std::string three_angles = R"(
[scene]
kind = "grid"
duration_s = 2
[grid]
difference = 0.01
[grid.x]
key = "mass_ratio"
from = 0.5
to = 2
step = 0.5
[grid.color]
key = "theta1_deg"
values = [30, 60, 120.5]
)";

TEST(Grid, HasACurveForEachColor) {
    const auto figure = figure_from(three_angles);
    const auto trials = computed(figure);
    const Table table(table_text(figure, trials));
    EXPECT_EQ(table.columns, (std::vector<std::string>{"theta1_deg", "mass_ratio", "average_log_ratio"}));
    ASSERT_EQ(table.rows.size(), 12u);
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = table.rows[4 * i][0];
        const auto alone = table_of(figure_from(three_angles, {fmt::format("grid.color.values=[{}]", angle)}));
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(table.rows[4 * i + k], alone.rows[k]) << i << k;
    }
    Figure page;
    figure.experiment->draw(trials, page);
    ASSERT_EQ(page.panels.size(), 1u);
    ASSERT_EQ(page.panels[0].curves.size(), 3u);
    EXPECT_EQ(page.panels[0].curves[2].label, "θ₁ = 120.5°");
    EXPECT_EQ(page.panels[0].curves[2].hue, 2);
    EXPECT_EQ(figure.subtitle,
              "two links in angles, θ₂ = 90°, mass ratios m₁/m₂ apart by 0.01; explicit Euler, 1/30 000 s");
}

TEST(Grid, HasAPanelForEachMethodWithTheNumbersOfItAlone) {
    const auto figure =
        figure_from(three_angles, {"grid.panel.key=\"system.integrator\"", "grid.panel.values=[\"rk4\", \"taylor\"]"});
    const auto text = table_text(figure, computed(figure));
    EXPECT_TRUE(text.starts_with("theta1_deg,method,mass_ratio,average_log_ratio\r\n30,rk4,0.5,")) << text;
    for (const std::string method : {"rk4", "taylor"}) {
        const auto single = figure_from(three_angles, {"system.integrator=\"" + method + "\""});
        std::istringstream lines(table_text(single, computed(single)));
        std::string line;
        for (std::getline(lines, line); std::getline(lines, line);)
            EXPECT_NE(text.find(line.insert(line.find(','), "," + method)), std::string::npos) << line;
    }
    const auto page = page_of(figure);
    ASSERT_EQ(page.panels.size(), 2u);
    EXPECT_EQ(page.panels[1].title, "taylor");
    EXPECT_EQ(figure.subtitle, "two links, θ₂ = 90°, mass ratios m₁/m₂ apart by 0.01");
    // a value that the key rejects
    expect_refused({"system.integrator values", "did you mean \"rk4\"?"}, [] {
        figure_from(three_angles, {"grid.panel.key=\"system.integrator\"", "grid.panel.values=[\"rk4\", \"rk5\"]"});
    });
}

TEST(Grid, TablesOfKeysKeepTheirDecimals) {
    const auto figure = figure_from(
        three_angles,
        {"grid.color.key=\"system\"", "grid.color.values=[{ angle_deg = [120.1, 90] }, { angle_deg = [30, 90] }]"});
    const auto text = table_text(figure, computed(figure));
    EXPECT_NE(text.find("120.1, 90"), std::string::npos) << text;
}

TEST(Grid, ExplainsTheEnergyBoundOfAnyQuantity) {
    const auto figure = figure_of(
        "flip-map", {"grid.quantity=\"energy_error\"", "grid.x.points=4", "grid.y.points=4", "scene.duration_s=1"});
    const auto page = page_of(figure);
    EXPECT_EQ(page.captions, std::vector<std::string>{"Inside the line no rod has the energy to flip."});
}

TEST(Grid, TakesAnyKeyForPanelsOfMaps) {
    const auto figure = figure_from(
        "[scene]\nkind = \"grid\"\nduration_s = 1\n[grid]\nquantity = \"energy_error\"\n[grid.x]\nkey = "
        "\"system.length_m[1]\"\nfrom = 0.5\nto = 2\npoints = 3\n[grid.y]\nkey = \"mass_ratio\"\nfrom = 0.1\nto = 10\n"
        "spacing = \"logarithmic\"\npoints = 2\n[grid.panel]\nkey = \"system.angle_deg\"\nvalues = [[90, 0], [45.5, "
        "0]]");
    EXPECT_EQ(figure.experiment->trials(), 4u);
    const auto trials = computed(figure);
    EXPECT_NE(table_text(figure, trials).find("\r\n\"[45.5, 0]\",0.75,"), std::string::npos);
    Figure page;
    figure.experiment->draw(trials, page);
    ASSERT_EQ(page.panels.size(), 2u);
    EXPECT_TRUE(page.shares_axes);
    for (const auto& panel : page.panels) {
        EXPECT_TRUE(panel.map->shares_bar);
        EXPECT_EQ(panel.map->low, page.panels[0].map->low);
        EXPECT_EQ(panel.map->high, page.panels[0].map->high);
    }
    EXPECT_NE(page.panels[0].map->values, page.panels[1].map->values);
    EXPECT_EQ(figure.subtitle, "two links in angles; explicit Euler, 1/30 000 s");
}

TEST(Grid, GreatestDistancesAreThoseOfAFilm) {
    const auto table = table_of(figure_from(twins, {"grid.quantity=\"greatest_distance\"", "scene.duration_s=6"}));
    const auto scene = film(table.rows[1][0]);
    PairRun run(scene);
    double maximum = 0;
    for (long n = 0; n <= scene.samples / 2; ++n) maximum = std::max(maximum, run.next(false).distance);
    EXPECT_EQ(table.rows[1][1], maximum);
}

TEST(Grid, PeriodsAreThoseOfTheEllipticIntegral) {
    const auto table = table_of(
        figure_from("[scene]\nkind = \"grid\"\nduration_s = 40\n[system]\nlinks = 1\nangle_deg = 10\nintegrator = "
                    "\"taylor\"\ntolerance = 1e-14\n[grid]\nquantity = \"period\"\n[grid.x]\nvalues = [0.5, 90, 175]"));
    ASSERT_EQ(table.rows.size(), 3u);
    for (const auto& row : table.rows) {
        const double period = 4 * std::sqrt(1 / 9.8) * std::comp_ellint_1(std::sin(row[0] * pi / 360));
        EXPECT_NEAR(row[1], period, 1e-8) << row[0];
    }
    // none within too short a time, and none for a pendulum at rest
    const auto none = figure_from(
        "[scene]\nkind = \"grid\"\nduration_s = 1\n[system]\nlinks = 1\nangle_deg = 1\n[grid]\nquantity = \"period\"\n"
        "[grid.x]\nvalues = [0, 90]");
    EXPECT_EQ(none.experiment->nothing_to_draw(computed(none)),
              "none of the 2 pairs has a period: no whole period within 1 s");
}

TEST(Grid, TakesAnotherFormOfAnAxisFromTheCommandLine) {
    const std::string brief = "scene.duration_s=0.5";
    EXPECT_EQ(table_of(figure_of("fig2-right", {"grid.x.values=[10,20,30]", brief})).rows.size(), 3u);
    EXPECT_EQ(table_of(figure_of("flip-map", {"grid.x.step=60", "grid.y.step=90", brief})).rows.size(), 24u);
    EXPECT_EQ(table_of(figure_of("fig2-right", {"grid.x.points=4", brief})).rows.size(), 4u);
}

TEST(Grid, PeriodsOfRotationsAreThoseOfWholeTurns) {
    // gravity is too small to matter
    for (const std::string rate : {"720", "-720"}) {
        const auto figure = figure_from(
            "[scene]\nkind = \"grid\"\nduration_s = 5\n[system]\nlinks = 1\nangle_deg = 0\nomega_deg_per_s = " + rate +
            "\ngravity_m_per_s2 = 1e-9\nintegrator = \"rk4\"\n[grid]\nquantity = \"period\"\n[grid.x]\n"
            "key = \"system.length_m[0]\"\nvalues = [1, 2]\n");
        for (const auto& row : table_of(figure).rows) EXPECT_NEAR(row[1], 0.5, 1e-9) << rate;
    }
}

/// The exponents of chains with more and more links equal those of largest_exponent(); and the cost of their steps.
TEST(Grid, OfLinksHasTheExponentsOfTheChains) {
    const auto figure = figure_of("links", {"grid.x.to=4", "grid.exponent_duration_s=10", "system.mass_kg=2"});
    const auto table = table_of(figure);
    EXPECT_EQ(table.columns, (std::vector<std::string>{"links", "exponent_per_s", "exponent_uncertainty_per_s",
                                                       "angles_step_ns", "constraints_step_ns", "exponent_unsettled"}));
    ASSERT_EQ(table.rows.size(), 3u);
    for (const auto& row : table.rows) {
        SideSpec side;
        side.set_links(static_cast<std::size_t>(row[0]));
        side.mass_kg.assign(side.links(), 2);
        const auto exponent = largest_exponent(chain_of(side).cast<double>(), {.duration_s = 10}, false);
        EXPECT_EQ(row[1], exponent.value);
        EXPECT_EQ(row[2], exponent.uncertainty);
        EXPECT_GT(row[3], 0);
        EXPECT_GT(row[4], 0);
    }
}

/// A grid of RK4's energy errors, without axes.
const std::string of_energy =
    "[scene]\nkind = \"grid\"\nduration_s = 1\n[system]\nintegrator = \"rk4\"\n[grid]\nquantity = \"energy_error\"\n";

/// Cells of listed values and of whole numbers have the numbers of curves, and lie around their values.
TEST(Grid, MapsTakeValuesAndWholeNumbersAsCentres) {
    const std::string top = of_energy + "[grid.x]\nkey = \"links\"\nfrom = 2\nto = 4\n";
    const std::string of_mass = "key = \"system.mass_kg\"\nvalues = [0.5, 1, 2]\n";
    const auto map = figure_from(top + "[grid.y]\n" + of_mass);
    const auto cells = table_of(map), curves = table_of(figure_from(top + "[grid.color]\n" + of_mass));
    ASSERT_EQ(cells.rows.size(), 9u);
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_EQ(cells.rows[i][0], curves.rows[i][1]) << i;  // links
        EXPECT_EQ(cells.rows[i][1], curves.rows[i][0]) << i;  // kg
        EXPECT_EQ(cells.rows[i][2], curves.rows[i][2]) << i;
    }
    const auto panel = page_of(map).panels.at(0);
    EXPECT_EQ(panel.x.low, 1.5);
    EXPECT_EQ(panel.x.high, 4.5);
    EXPECT_TRUE(panel.y.logarithmic);
    EXPECT_NEAR(*panel.y.low, std::sqrt(0.125), 1e-15);
    EXPECT_NEAR(*panel.y.high, std::sqrt(8.0), 1e-15);
    EXPECT_EQ(panel.y.ticks, (std::vector<Tick>{{0.5, "0.5"}, {1, "1"}, {2, "2"}}));
    const auto even =
        page_of(figure_from(top + "[grid.y]\nkey = \"system.length_m\"\nvalues = [1, 1.5, 2]\n")).panels.at(0).y;
    EXPECT_FALSE(even.logarithmic);
    EXPECT_EQ(even.low, 0.75);
    EXPECT_EQ(even.high, 2.25);
}

/// Whichever axis has the number of links; and no axis is an element that the shortest chain lacks.
TEST(Grid, MapsOfLinksSetTheirNumberFirst) {
    const auto& top = of_energy;
    const std::string links = "key = \"links\"\nfrom = 2\nto = 3\n";
    const std::string mass = "key = \"system.mass_kg[1]\"\nvalues = [0.5, 1, 2]\n";
    const auto columns = table_of(figure_from(top + "[grid.x]\n" + links + "[grid.y]\n" + mass));
    const auto rows = table_of(figure_from(top + "[grid.x]\n" + mass + "[grid.y]\n" + links));
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(columns.rows[2 * k + i][2], rows.rows[3 * i + k][2]) << i << k;
    EXPECT_NE(rows.rows[3][2], rows.rows[4][2]);  // of three links
    expect_refused({"is beyond the array, whose last element is [1]"}, [&] {
        figure_from(
            top + "[grid.x]\n" + links + "[grid.y]\nkey = \"system.mass_kg[2]\"\nfrom = 1\nto = 2\npoints = 2\n",
            {"system.links=3"});
    });
}

/// A ratio holds whatever the other axis changes; a side keeps what is its own.
TEST(Grid, MapsSetRatiosAndSidesLast) {
    const std::string top =
        "[scene]\nkind = \"grid\"\nduration_s = 2\n[system]\nintegrator = \"rk4\"\n[b]\nangle_deg = [90.01, 90]\n"
        "[grid]\nquantity = \"distance_at_end\"\n";
    const std::string ratio = "key = \"mass_ratio\"\nvalues = [1, 2]\n";
    const std::string mass = "key = \"system.mass_kg[1]\"\nvalues = [1, 3]\n";
    const auto columns = table_of(figure_from(top + "[grid.x]\n" + ratio + "[grid.y]\n" + mass));
    const auto rows = table_of(figure_from(top + "[grid.x]\n" + mass + "[grid.y]\n" + ratio));
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(columns.rows[2 * k + i][2], rows.rows[2 * i + k][2]) << i << k;
    // the motion of ideal links depends on the ratio alone
    EXPECT_NEAR(columns.rows[0][2], columns.rows[2][2], 1e-12);
    EXPECT_GT(std::abs(columns.rows[0][2] - columns.rows[1][2]), 1e-6);
    const std::string of_b = "key = \"b.mass_kg[1]\"\nvalues = [1, 3]\n",
                      of_both = "key = \"system.mass_kg[1]\"\nvalues = [2, 4]\n";
    EXPECT_EQ(table_of(figure_from(top + "[grid.x]\n" + of_b + "[grid.y]\n" + of_both)).rows[1][2],
              table_of(figure_from(top + "[grid.x]\n" + of_both + "[grid.y]\n" + of_b)).rows[2][2]);
}

/// Two values far apart are spaced by ratios, so that no mass is negative; uneven whole numbers are refused.
TEST(Grid, MapsHaveEvenCellsWithinTheBoundsOfTheirKey) {
    const std::string top = of_energy + "[grid.x]\nkey = \"links\"\nfrom = 2\nto = 4\n";
    const auto axis =
        page_of(figure_from(top + "[grid.y]\nkey = \"system.mass_kg\"\nvalues = [0.01, 1]\n")).panels.at(0).y;
    EXPECT_TRUE(axis.logarithmic);
    EXPECT_NEAR(*axis.low, 0.001, 1e-15);
    // edges out of range are no fault where the values allow nothing else, and of whole numbers
    const auto linear = page_of(figure_from(of_energy + "[grid.x]\nkey = \"links\"\nfrom = 1\nto = 2\n[grid.y]\nkey = "
                                                        "\"system.mass_kg\"\nvalues = [0.1, 0.5, 0.9]\n"))
                            .panels.at(0);
    EXPECT_EQ(linear.x.low, 0.5);
    EXPECT_FALSE(linear.y.logarithmic);
    expect_refused({"[grid.x] points must increase by equal steps"},
                   [&] { figure_from(top + "points = 5\n[grid.y]\nkey = \"theta2_deg\"\n"); });
}

TEST(Grid, WhatIsComparedHasOneRange) {
    for (const char* name : {"fig2-right", "fig4-right", "fig8", "true-fig2-right"}) {
        const auto axis = page_of(figure_of(name, {"grid.x.to=2", "scene.duration_s=1"})).panels.at(0).y;
        EXPECT_EQ(axis.low, 0) << name;
        EXPECT_EQ(axis.high, 12) << name;
    }
}

TEST(Grid, LeavesEquilibriaOutOfTheCurveNotOutOfTheTable) {
    const auto figure = figure_of("fig3-left", {"grid.x.step=90", "scene.duration_s=1"});
    const auto page = page_of(figure);
    const auto& curve = page.panels.at(0).curves.at(0);
    ASSERT_EQ(curve.y.size(), 3u);
    EXPECT_TRUE(std::isnan(curve.y[0]) && std::isfinite(curve.y[1]) && std::isnan(curve.y[2]));
    EXPECT_EQ(page.captions.at(0), "Not drawn: θ₁ = 0° and θ₁ = 180°, where both pendulums rest in equilibrium.");
    const auto table = table_of(figure);
    EXPECT_EQ(table.rows[0][1], 0);
    EXPECT_EQ(table.rows.size(), 3u);
    // two pendulums with different angles do not rest
    EXPECT_TRUE(page_of(figure_of("fig2-right", {"grid.x.step=90", "scene.duration_s=1"})).captions.empty());
    EXPECT_EQ(page_of(figure_of("fig3-left", {"grid.x.step=90", "grid.x.to=540", "scene.duration_s=1"})).captions.at(0),
              "Not drawn: 4 values from θ₁ = 0° to θ₁ = 540°, where both pendulums rest in equilibrium.");
}

TEST(Grid, SaysWhyACurveLacksPoints) {
    const std::vector<std::string> flips{"grid.quantity=flip_time", "grid.x.step=60", "scene.duration_s=3",
                                         "grid.color={key=\"theta2_deg\",values=[0,170]}"};
    EXPECT_EQ(page_of(figure_of("fig2-right", flips)).captions,
              std::vector<std::string>{"Not drawn: no flip within 3 s."});
    const auto none = figure_of(
        "fig2-right", {"grid.quantity=flip_time", "grid.right=parting_time", "grid.x.to=2", "scene.duration_s=3"});
    EXPECT_EQ(none.experiment->nothing_to_draw(computed(none)),
              "none of the 3 pairs has a flip_time: no flip within 3 s");
}

TEST(Grid, DrawsTheConvergedCurveOverKaos) {
    const auto figure = figure_of("true-fig2-right", {"grid.x.from=90", "grid.x.to=91", "scene.duration_s=2"});
    const auto table = table_of(figure);
    EXPECT_EQ(table.columns, (std::vector<std::string>{"system", "theta1_deg", "average_log_ratio"}));
    ASSERT_EQ(table.rows.size(), 4u);
    EXPECT_EQ(table.words[2][0], "converged in double precision");
    const auto study = table_of(figure_of("fig2-right", {"grid.x.from=90", "grid.x.to=91", "scene.duration_s=2"}));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(table.rows[i].back(), study.rows[i][1]);
    const auto curves = page_of(figure).panels.at(0).curves;
    EXPECT_EQ(curves.at(1).label, "converged in double precision");
}

TEST(Grid, NamesDriveAndDamping) {
    EXPECT_EQ(
        figure_of("bifurcation").subtitle,
        "one link in angles, viscous friction 0.45887 N m s, torque \"motor\" frequency 0.5 Hz, released from 10°; "
        "Dormand–Prince 8(5,3), tolerance 10⁻¹⁰");
    const std::string swept = "grid.x.key=\"system.torque.motor.frequency_hz\"";
    EXPECT_TRUE(
        figure_of("bifurcation", {swept}).subtitle.find("torque \"motor\" amplitude 4.3247 N m, released from 10°") !=
        std::string::npos);
    EXPECT_EQ(figure_of("kapitza-map").subtitle,
              "one link in angles, pivot direction 90°, released from 177°; Dormand–Prince 5(4), tolerance 0.0001");
}

TEST(Grid, TwoToneMapsNameBothBranches) {
    const auto page = page_of(figure_of("kapitza-map", {"grid.x.points=4", "grid.y.points=3", "scene.duration_s=1",
                                                        "system.integrator=rk4", "system.pivot.direction_deg=270"}));
    const auto& plot = page.panels.at(0);
    EXPECT_EQ(plot.map->threshold, 90);
    ASSERT_EQ(plot.curves.size(), 2u);
    for (const auto& curve : plot.curves) EXPECT_NE(curve.label, "");
}

TEST(Grid, SaysWhatIsDashed) {
    const auto page = page_of(figure_from(three_angles, {"grid.right=\"distance_at_end\"", "grid.color.values=[30]"}));
    EXPECT_EQ(page.captions, std::vector<std::string>{"Dashed: distance after 2 s."});
}

TEST(Grid, TheChoiceOfItsMethodCanBeInterrupted) {
    const std::atomic<bool> stop = true;
    const PresetText preset{"x", "presets/x.toml",
                            "[scene]\nkind = \"grid\"\n[system]\nlinks = 6\naccuracy = 1e-6\n"
                            "model = \"constraints\"\n[grid]\ndifference = 0.01\n"};
    test::expect_error(ExitCode::interrupted, {"interrupted"}, [&] { read_figure(preset, {}, stop); });
}

}  // namespace doppel::grid_test

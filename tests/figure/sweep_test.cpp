#include "analysis/difference.hpp"
#include "figure/map_figure.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace sweep_test {

const std::string twins = R"(
[scene]
kind = "sweep"
duration_s = 12
[system]
angle_deg = [120, 80]
[b]
angle_deg = [120.01, 80]
[sweep]
parameter = "system.mass_kg[1]"
from = 0.5
to = 2
step = 0.5
)";

/// The pair of trial i as a film has it.
Scene film(double mass) {
    auto preset = read_preset({"x", "x.toml",
                               "[scene]\nduration_s = 12\n[system]\nangle_deg = [120, 80]\n"
                               "[b]\nangle_deg = [120.01, 80]\n"});
    preset.a.mass_kg[1] = preset.b.mass_kg[1] = Quad(mass);
    return make_scene(preset);
}

TEST(Sweep, InLanesFindsWhatAFilmShows) {
    const auto distances = table_of(figure_from(twins, {"sweep.quantity=\"distance_at_end\""})),
               partings = table_of(figure_from(twins, {"sweep.quantity=\"parting_time\""})),
               errors = table_of(figure_from(twins, {"sweep.quantity=\"energy_error\""}));
    EXPECT_EQ(distances.columns, (std::vector<std::string>{"system.mass_kg[1]", "distance_at_end"}));
    ASSERT_EQ(distances.rows.size(), 4u);
    long parted = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto scene = film(distances.rows[i][0]);
        PairRun run(scene);
        Parting parting;
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

TEST(Sweep, OneByOneFindsWhatLanesFind) {
    // a spring next to none makes it a mechanism
    const std::string spring =
        "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\nstiffness_N_per_m = 1e-12\n";
    for (const char* quantity : {"flip_time", "energy_error", "divergence"}) {
        const std::vector<std::string> sets{fmt::format("sweep.quantity=\"{}\"", quantity), "scene.duration_s=4",
                                            "system.integrator=\"rk4\""};
        const auto lanes = table_of(figure_from(twins, sets)), alone = table_of(figure_from(twins + spring, sets));
        for (std::size_t i = 0; i < lanes.rows.size(); ++i)
            if (std::isfinite(lanes.rows[i][1]) || std::isfinite(alone.rows[i][1])) {
                EXPECT_NEAR(lanes.rows[i][1], alone.rows[i][1], 1e-8) << quantity << ' ' << i;  // measured 1.8e-10
            }
    }
}

TEST(Sweep, OfEqualRatiosHasItsEndsAndTheStepsThatAreTaken) {
    const auto table = table_of(figure_from(
        "[scene]\nkind = \"sweep\"\nduration_s = 2\n[system]\nintegrator = \"rk4\"\nangle_deg = [60, 60]\n[sweep]\n"
        "parameter = \"system.step_s\"\nfrom = 0.0001\nto = 0.008\npoints = 9\nspacing = \"logarithmic\"\n"
        "quantity = \"energy_error\"\n"));
    ASSERT_EQ(table.rows.size(), 9u);
    EXPECT_EQ(table.rows[0][0], 1.0 / (120 * 83));
    EXPECT_EQ(table.rows[8][0], 1.0 / 120);
    // of order 4
    const double slope = std::log(table.rows[8][1] / table.rows[5][1]) / std::log(table.rows[8][0] / table.rows[5][0]);
    EXPECT_NEAR(slope, 4, 0.1);  // measured 3.98
}

TEST(Map, SaysOfItselfByWhatItIsFound) {
    const auto subtitle = [](const std::string& quantity, const std::vector<std::string>& sets = {}) {
        auto all = sets;
        all.insert(all.end(),
                   {"map.columns=4", "map.rows=3", "scene.duration_s=1", "map.quantity=\"" + quantity + "\""});
        return figure_of("parting-map", all).subtitle;
    };
    EXPECT_EQ(subtitle("divergence"), "two links in angles, θ₂ = 0, twins 0.001° apart; Runge–Kutta 4, 1/480 s");
    EXPECT_EQ(subtitle("energy_error"), "two links in angles, θ₂ = 0; Runge–Kutta 4, 1/480 s");
    EXPECT_EQ(subtitle("exponent"), "two links in angles, θ₂ = 0; tangent equations by Dormand–Prince 8");
    EXPECT_EQ(subtitle("flip_time"), "two links in angles, θ₂ = 0; Taylor series, tolerance 1.0 × 10⁻⁸");
    // what is varied is no number of all
    EXPECT_EQ(subtitle("energy_error", {"map.x_parameter=\"system.step_s\"", "map.x_from=0.0001", "map.x_to=0.002",
                                        "map.difference=0"}),
              "two links in angles, 90°/0°; Runge–Kutta 4");
}

TEST(Map, HasTheNumbersOfSweeps) {
    const auto map = table_of(figure_from(
        "[scene]\nkind = \"map\"\nduration_s = 3\n[system]\nangle_deg = [0, 100]\n[map]\n"
        "x_parameter = \"system.angle_deg[0]\"\nx_from = 5\nx_to = 175\ncolumns = 17\ny_parameter = \"mass_ratio\"\n"
        "y_from = 0.1\ny_to = 10\ny_spacing = \"logarithmic\"\nrows = 5\nquantity = \"divergence\"\n"
        "difference = 0.01\n"));
    ASSERT_EQ(map.rows.size(), 17u * 5);
    EXPECT_EQ(map.columns, (std::vector<std::string>{"system.angle_deg[0]", "mass_ratio", "average_log_ratio"}));
    const std::size_t row = 3;
    const double ratio = map.rows[row * 17][1];
    EXPECT_NEAR(ratio, std::pow(10, -1 + 2 * 3.5 / 5), 1e-14);
    const auto sweep = table_of(figure_from(fmt::format(
        "[scene]\nkind = \"sweep\"\nduration_s = 3\n[system]\nangle_deg = [0, 100]\nmass_kg = [{:.17g}, 1]\n[sweep]\n"
        "parameter = \"theta1_deg\"\nfrom = 10\nto = 170\nstep = 10\ndifference = 0.01\n",
        ratio)));
    for (std::size_t i = 0; i < 17; ++i) {
        EXPECT_EQ(map.rows[row * 17 + i][0], sweep.rows[i][0]);
        EXPECT_NEAR(map.rows[row * 17 + i][2], sweep.rows[i][1], 1e-9) << i;  // the ratio is rounded
    }
}

TEST(Map, OfFlipsIsTheFlipMap) {
    const std::string size = "columns = 24\nrows = 21\n";
    const auto map = figure_from("[scene]\nkind = \"map\"\nduration_s = 8\n[map]\n" + size),
               flips = figure_from("[scene]\nkind = \"flip-map\"\n[flip_map]\nduration_s = 8\nchecked = 0\n" + size);
    EXPECT_EQ(map.experiment->trials(), 21u);
    EXPECT_EQ(flips.experiment->trials(), 11u);  // the other half mirrors it
    const auto one = table_of(map), other = table_of(flips);
    ASSERT_EQ(one.rows.size(), other.rows.size());
    long flipped = 0;
    for (std::size_t i = 0; i < one.rows.size(); ++i) {
        EXPECT_EQ(one.rows[i][0], other.rows[i][0]);
        EXPECT_EQ(one.rows[i][1], other.rows[i][1]);
        EXPECT_EQ(std::isfinite(one.rows[i][2]), std::isfinite(other.rows[i][2])) << i;
        if (!std::isfinite(one.rows[i][2])) continue;
        ++flipped;
        EXPECT_NEAR(one.rows[i][2], other.rows[i][2], 1e-9) << i;  // degrees to radians in quad, and in double
    }
    EXPECT_GT(flipped, 200);
}

TEST(FlipMap, OfAPartHasTheCellsOfTheWhole) {
    const std::string start = "[scene]\nkind = \"flip-map\"\n[flip_map]\nduration_s = 8\nchecked = 20\n";
    const auto whole = table_of(figure_from(start + "columns = 16\nrows = 16\n")),
               part = table_of(figure_from(start + "columns = 8\nrows = 4\ntheta1_range_deg = [0, 180]\n"
                                                   "theta2_range_deg = [-90, 0]\n"));
    ASSERT_EQ(part.rows.size(), 32u);
    for (std::size_t r = 0; r < 4; ++r)
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t k = 0; k < 3; ++k) {
                const double one = part.rows[8 * r + c][k], other = whole.rows[16 * (r + 4) + c + 8][k];
                EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other))) << r << ' ' << c << ' ' << k;
            }
    // where no release has the energy to flip, checks come to an end
    const auto still = table_of(figure_from(start + "columns = 4\nrows = 4\ntheta1_range_deg = [-1, 1]\n"
                                                    "theta2_range_deg = [-1, 1]\n"));
    for (const auto& row : still.rows) EXPECT_TRUE(std::isnan(row[2]));
}

TEST(Sweep, TheChoiceOfItsMethodHeedsAnInterruption) {
    const std::atomic<bool> stop = true;
    const PresetText preset{"x", "presets/x.toml",
                            "[scene]\nkind = \"sweep\"\n[system]\nlinks = 6\naccuracy = 1e-6\n"
                            "model = \"constraints\"\n[sweep]\nparameter = \"theta1_deg\"\ndifference = 0.01\n"};
    test::expect_error(ExitCode::interrupted, {"interrupted"}, [&] { read_figure(preset, {}, {}, stop); });
}

}  // namespace sweep_test
}  // namespace doppel

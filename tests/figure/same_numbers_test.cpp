#include "figure/support.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

namespace doppel::same_numbers_test {

namespace fs = std::filesystem;
using test::bytes_of;
using test::fresh_folder;

// A figure's numbers are bit-identical for every number of threads, groups and parts.

using Case = PresetCase;

class SameNumbers : public testing::TestWithParam<Case> {
protected:
    FigurePreset figure() const {
        auto arguments = GetParam().sets;
        arguments.emplace_back("chart.size=[480, 270]");
        return figure_of(GetParam().name, arguments);
    }
};

/// The files of a run: table and picture.
std::pair<std::string, std::string> table_and_picture(const fs::path& out, const FigurePreset& figure) {
    const auto base = out / figure.name / figure.name;
    return {bytes_of(base.string() + ".csv"), bytes_of(base.string() + ".png")};
}

TEST_P(SameNumbers, WithAnyNumberOfThreads) {
    const auto figure = this->figure();
    const auto one = computed(figure, 1);
    const auto table = table_text(figure, one);
    EXPECT_GT(table.size(), 100u);
    for (const int jobs : {2, 5}) EXPECT_EQ(table_text(figure, computed(figure, jobs)), table) << jobs;
}

TEST_P(SameNumbers, InAnyOrder) {
    const auto figure = this->figure();
    const std::atomic<bool> never = false;
    KnownTrials trials(figure.experiment->trials());
    for (std::size_t i = trials.size(); i-- > 0;) trials[i] = figure.experiment->compute(i, never);
    EXPECT_EQ(table_text(figure, trials), table_text(figure, computed(figure)));
}

TEST_P(SameNumbers, AfterAMergeOfAnyParts) {
    const auto figure = this->figure();
    const auto folder = fresh_folder();
    run_figure(figure, {.out = folder / "whole", .jobs = 1});
    const auto expected = table_and_picture(folder / "whole", figure);
    for (const int of : {1, 3, static_cast<int>(figure.experiment->trials()) + 2}) {  // the last one gives empty parts
        const auto out = folder / std::to_string(of);
        for (int i = of; i >= 1; --i) run_figure(figure, {.out = out, .jobs = 1 + i % 2, .shard = Shard{i, of}});
        run_figure(figure, {.out = out, .merge = true});
        const auto merged = table_and_picture(out, figure);
        EXPECT_EQ(merged.first, expected.first) << of;
        EXPECT_TRUE(merged.second == expected.second) << "the picture after a merge of " << of;
    }
}

TEST_P(SameNumbers, FromTheResolvedPreset) {
    const auto figure = this->figure();
    const auto again = read_figure({figure.name, "resolved.toml", figure.resolved()});
    EXPECT_EQ(again.resolved(), figure.resolved());
    EXPECT_EQ(header_of(again), header_of(figure));
    EXPECT_EQ(table_text(again, computed(again)), table_text(figure, computed(figure)));
}

INSTANTIATE_TEST_SUITE_P(
    Figures, SameNumbers,
    testing::Values(
        Case{"fig2-right", {"grid.x.step=15", "scene.duration_s=2"}},
        Case{"true-fig2-right", {"grid.x.step=5", "scene.duration_s=2"}},
        Case{"fig3-right", {"grid.x.to=0.19", "scene.duration_s=2"}}, Case{"fig6", {"scene.duration_s=2"}},
        Case{"flip-map", {"grid.x.points=40", "grid.y.points=41", "scene.duration_s=3"}},
        Case{"bifurcation", {"grid.x.points=6", "grid.transient_periods=3", "grid.periods=4"}},
        Case{"kapitza-map", {"grid.x.points=5", "grid.y.points=4", "scene.duration_s=1"}},
        Case{"parting-map", {"grid.x.points=17", "grid.y.points=5", "scene.duration_s=1"}},
        Case{"fig4-right",
             {"grid.x.points=7", "grid.x.key=\"system.mass_kg[1]\"", "grid.x.spacing=\"logarithmic\"",
              "grid.x.from=0.1", "grid.x.to=10", "system.angle_deg=[100, 30]", "grid.quantity=\"flip_time\"",
              "grid.difference=0", "scene.duration_s=6"}},
        Case{"fig5-right",
             {"grid.x.points=5", "grid.quantity=\"energy_error\"", "system.integrator=\"taylor\"",
              "system.model=\"angles\"", "scene.duration_s=1"}},
        Case{"parting-map",
             {"grid.x.points=5", "grid.y.points=3", "scene.duration_s=1", "grid.panel.key=\"system.integrator\"",
              "grid.panel.values=[\"rk4\", \"dop853\"]"}},
        Case{"fig3-right",
             {"grid.x.to=0.05", "scene.duration_s=1", "grid.color.key=\"theta2_deg\"", "grid.color.values=[10, 20]"}},
        Case{"poincare",
             {"section.energy_J=[9.8, 20]", "section.orbits=3", "section.crossings=10",
              "section.exponent_duration_s=50"}},
        Case{"drift", {"series.duration_s=20", "series.methods=[\"euler\", \"dop853\", \"gauss4\"]"}},
        Case{"speed-accuracy",
             {"chart.cost=\"evaluations\"", "work_precision.problems=[\"P3\"]", "work_precision.most_evaluations=5000",
              "work_precision.methods=[\"rk4\", \"adams\", \"taylor\", \"rattle\"]"}},
        Case{"lyapunov-spectrum", {"series.duration_s=5", "series.samples=10"}},
        Case{"driven-spectrum", {"series.duration_s=5", "series.samples=10"}},
        Case{"why-they-part",
             {"scene.duration_s=0.2", "grid.color.values=[\"euler\", \"gauss6/rattle6\", \"dop853\"]",
              "grid.x.points=4", "grid.x.to=0.001", "grid.x.tolerance_points=4"}},
        Case{"stability", {"grid.x.points=5", "grid.y.points=4", "scene.duration_s=2"}},
        Case{"stability-mass",
             {"grid.x.points=300", "grid.y.points=2", "scene.duration_s=1", "scene.sample_hz=50",
              "grid.panel.values=[\"euler\", \"dopri5\"]"}}),
    [](const auto& parameter) { return name_of_case(parameter.param, parameter.index); });

/// A mirrored row is not computed. With a zero impulse every row is computed, and the numbers are the same.
TEST(FlipMap, MirroredRowsAreThoseComputed) {
    const std::vector<std::string> small{"grid.x.points=16", "grid.y.points=15", "scene.duration_s=4"};
    const auto figure = figure_of("flip-map", small);
    auto pushed = small;
    pushed.insert(pushed.end(), {"system.omega_deg_per_s=[1e-300, 0]", "grid.overlay=\"none\""});
    const auto whole = figure_of("flip-map", pushed);
    EXPECT_EQ(figure.experiment->trials(), 8u);
    EXPECT_EQ(whole.experiment->trials(), 15u);
    EXPECT_EQ(table_text(figure, computed(figure)), table_text(whole, computed(whole)));
}

}  // namespace doppel::same_numbers_test

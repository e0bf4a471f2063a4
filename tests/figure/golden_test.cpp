#include "output/golden.hpp"

#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::golden_test {

/// A figure that does not depend on the last bit: nothing chaotic beyond 3 s, no measured times.
struct Golden {
    const char* name;  // of the image file
    const char* preset;
    std::vector<std::string> sets;
};

void PrintTo(const Golden& golden, std::ostream* out) {
    *out << golden.name;
}

class GoldenFigure : public testing::TestWithParam<Golden> {};

TEST_P(GoldenFigure, IsAsItWas) {
    auto arguments = GetParam().sets;
    arguments.insert(arguments.end(), {"chart.size=[960, 540]", "chart.scale=0.5"});
    const auto figure = figure_of(GetParam().preset, arguments);
    test::expect_golden(GetParam().name, picture_of(compose_figure(figure, computed(figure))));
}

INSTANTIATE_TEST_SUITE_P(
    Presets, GoldenFigure,
    testing::Values(
        Golden{"figure-sweep", "fig2-right", {"grid.x.to=40"}}, Golden{"figure-curves", "fig6", {"scene.duration_s=3"}},
        Golden{"figure-curves-dark", "fig4-left", {"scene.duration_s=3", "chart.theme=\"dark\""}},
        // such coarse tolerances that the errors in the captions are truncation, not round-off
        Golden{"figure-flip-map",
               "flip-map",
               {"grid.x.points=48", "grid.y.points=48", "scene.duration_s=2", "grid.flip_tolerance=1e-4"}},
        Golden{"figure-spectrum",
               "lyapunov-spectrum",
               {"series.duration_s=3", "series.samples=24", "series.tolerance=1e-6"}},
        Golden{"figure-bifurcation",
               "bifurcation",
               {"grid.x.points=60", "grid.x.from=6", "grid.x.to=6.35", "grid.periods=20", "grid.transient_periods=60"}},
        Golden{"figure-kapitza-map",
               "kapitza-map",
               {"grid.x.points=24", "grid.y.points=16", "scene.duration_s=5", "chart.theme=\"dark\""}},
        Golden{"figure-section",
               "poincare",
               {"section.energy_J=[1, 39.2]", "section.orbits=6", "section.crossings=6",
                "section.exponent_duration_s=300"}},
        Golden{"figure-convergence",
               "why-they-part",
               {"scene.duration_s=1", "grid.color.values=[\"euler\", \"rk4\"]", "grid.x.points=5",
                "grid.x.to=0.000520833333333333333"}},
        // errors far above round-off
        Golden{"figure-work-precision",
               "speed-accuracy",
               {"chart.cost=\"evaluations\"", "work_precision.problems=[\"P1\", \"P3\"]",
                "work_precision.most_evaluations=20000", "work_precision.least_error=1e-6",
                "work_precision.models=[\"angles\", \"constraints\"]"}},
        // steps, times and angles without chaos
        Golden{"figure-stability",
               "stability",
               {"grid.y.to=30", "grid.y.points=18", "grid.x.points=24", "scene.duration_s=2", "scene.sample_hz=50",
                "grid.x.from=0.01", "grid.x.to=0.7",
                "grid.panel.values=[\"euler\", \"semi-implicit-euler\", \"rk4\", \"rattle6\"]"}}),
    [](const auto& parameter) { return underscored(parameter.param.name); });

}  // namespace doppel::golden_test

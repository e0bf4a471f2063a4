#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::numbers_test {

// Each kind of figure checks the numbers of its trials: impossible numbers in a file are rejected.

constexpr double infinite = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();

struct Case : PresetCase {
    bool may_be_none;  // whether the first trial may have no number
};

class Numbers : public testing::TestWithParam<Case> {};

TEST_P(Numbers, AreValidOnlyForTheirTrial) {
    const auto figure = figure_of(GetParam().name, GetParam().sets);
    const auto& work = *figure.experiment;
    const auto trials = computed(figure);
    for (std::size_t i = 0; i < trials.size(); ++i) {
        const auto& numbers = trials[i];
        EXPECT_TRUE(work.fits(i, numbers)) << i;
        EXPECT_FALSE(work.fits(i, {})) << i;
        EXPECT_FALSE(work.fits(i, std::span(numbers).first(numbers.size() - 1))) << i;
        auto more = numbers;
        more.push_back(0.5);
        EXPECT_FALSE(work.fits(i, more)) << i;
    }
    auto changed = trials[0];
    changed.back() = none;
    EXPECT_EQ(work.fits(0, changed), GetParam().may_be_none);
    changed.back() = -infinite;
    EXPECT_FALSE(work.fits(0, changed));
}

INSTANTIATE_TEST_SUITE_P(
    Figures, Numbers,
    testing::Values(
        Case{"fig2-right", {"grid.x.step=60", "scene.duration_s=1"}, true},
        Case{"fig2-right",
             {"grid.x.step=60", "scene.duration_s=1", "grid.right=\"exponent\"", "grid.exponent_duration_s=5"},
             false},
        // explicit Euler diverges at once in some trials
        Case{
            "fig2-right", {"grid.x.step=30", "scene.duration_s=6", "scene.sample_hz=5", "system.step_s=\"1/5\""}, true},
        Case{"fig2-left", {"scene.duration_s=1"}, true}, Case{"fig6", {"scene.duration_s=1"}, false},
        Case{"why-they-part",
             {"scene.duration_s=0.5", "grid.color.values=[\"euler\", \"dop853\"]", "grid.x.points=3", "grid.x.to=0.002",
              "grid.x.tolerance_points=3"},
             false},
        Case{"lyapunov-spectrum", {"series.duration_s=5", "series.samples=4"}, false},
        Case{"poincare", {"section.energy_J=[9.8]", "section.orbits=2", "section.crossings=5"}, false},
        Case{"flip-map", {"grid.x.points=8", "grid.y.points=8", "scene.duration_s=3"}, true},
        Case{"links", {"grid.x.to=3", "grid.exponent_duration_s=5"}, false},
        Case{"drift",
             {"series.duration_s=20", "series.methods=[\"rk4\", \"rattle\"]", "series.projected=[\"rk4\"]"},
             true},
        Case{"drift", {"series.duration_s=20", "series.methods=[\"euler\"]", "series.evaluations_per_s=20"}, true},
        Case{"stability",
             {"grid.x.points=3", "grid.y.points=3", "scene.duration_s=2",
              "grid.panel.values=[\"rk4\", \"gauss4\", \"dop853\"]"},
             true}),
    [](const auto& parameter) { return name_of_case(parameter.param, parameter.index); });

TEST(NumbersOfWork, AreThoseOfWholeSettings) {
    const auto figure = figure_of(
        "speed-accuracy",
        {"work_precision.problems=[\"P1\"]", "work_precision.models=[\"angles\"]", "work_precision.methods=[\"rk4\"]"});
    const auto& work = *figure.experiment;
    const TrialNumbers outcome{1e-3, 1e-6, none, 0, 1e-4, 400, 100, 0};
    auto two = outcome;
    two.insert(two.end(), outcome.begin(), outcome.end());
    EXPECT_TRUE(work.fits(1, outcome));
    EXPECT_TRUE(work.fits(1, two));
    EXPECT_TRUE(work.fits(1, TrialNumbers(8, none)));
    EXPECT_FALSE(work.fits(1, {}));
    EXPECT_FALSE(work.fits(1, std::span(two).first(15)));
    for (const double count : {-1.0, 0.5, 1e300, infinite}) {  // numbers of steps
        two[two.size() - 2] = count;
        EXPECT_FALSE(work.fits(1, two)) << count;
    }
    EXPECT_TRUE(work.fits(0, TrialNumbers{3}));
    EXPECT_FALSE(work.fits(0, TrialNumbers{3, 1e-20}));
    EXPECT_FALSE(work.fits(0, TrialNumbers{infinite}));
}

}  // namespace doppel::numbers_test

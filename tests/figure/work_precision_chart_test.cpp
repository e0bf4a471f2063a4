#include "figure/support.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace doppel {
namespace work_precision_chart_test {

// Which methods a work-precision chart colours.

Figure page_of(const FigurePreset& figure) {
    Figure page;
    figure.experiment->draw(computed(figure), page);
    return page;
}

std::set<std::string> labels_of(const Plot& plot) {
    std::set<std::string> labels;
    for (const auto& curve : plot.curves)
        if (!curve.label.empty()) labels.insert(curve.label);
    return labels;
}

long faint_ones(const Plot& plot) {
    return std::count_if(plot.curves.begin(), plot.curves.end(),
                         [](const Curve& curve) { return curve.background == Background::line; });
}

const std::vector<std::string> quick{"chart.cost=\"evaluations\"", "work_precision.most_evaluations=5000",
                                     "work_precision.models=[\"angles\"]"};

TEST(WorkPrecisionChart, HasFiveInColour) {
    auto arguments = quick;
    arguments.emplace_back("work_precision.problems=[\"P1\", \"P3\"]");
    const auto page = page_of(figure_of("speed-accuracy", arguments));
    ASSERT_EQ(page.panels.size(), 2u);
    for (const auto& plot : page.panels) {
        // the same five in every panel, and the study's point; the others of ten methods in angles are faint
        EXPECT_EQ(labels_of(plot),
                  (std::set<std::string>{"taylor", "adams", "dop853", "dopri5", "rk4", "the study: Euler, 30 kHz"}));
        EXPECT_EQ(faint_ones(plot), 10 - 5);
        for (const auto& curve : plot.curves)
            if (curve.background == Background::line) {
                EXPECT_TRUE(curve.quiet && curve.label.empty());
            }
        EXPECT_EQ(plot.curves.front().background, Background::band);
    }
    EXPECT_EQ(page.captions.size(), 2u);  // one more in a chart of times
    EXPECT_TRUE(page.captions[0].starts_with("In colour the five best, by the mean rank")) << page.captions[0];
}

TEST(WorkPrecisionChart, NamesAllOnDemand) {
    auto arguments = quick;
    arguments.insert(arguments.end(), {"work_precision.problems=[\"P1\"]", "chart.names=\"all\""});
    const auto page = page_of(figure_of("speed-accuracy", arguments));
    EXPECT_EQ(faint_ones(page.panels[0]), 0);
    EXPECT_EQ(labels_of(page.panels[0]).size(), 10u + 1);  // methods in angles, and the study's point
}

TEST(WorkPrecisionChart, NamesAllWhereTheyAreFew) {
    auto arguments = quick;
    arguments.insert(arguments.end(),
                     {"work_precision.problems=[\"P3\"]", "work_precision.methods=[\"rk4\", \"midpoint\"]"});
    const auto page = page_of(figure_of("speed-accuracy", arguments));
    EXPECT_EQ(faint_ones(page.panels[0]), 0);
    EXPECT_TRUE(labels_of(page.panels[0]).contains("midpoint"));
    EXPECT_TRUE(page.captions[0].starts_with("Each method in its best model;")) << page.captions[0];
}

/// Has the exact result at a given cost.
class Oracle final : public Motion {
public:
    explicit Oracle(long evaluations) : evaluations_(evaluations) {}
    void advance(const std::atomic<bool>& /*stop*/) override {}
    void advance_within(double /*share*/, const std::atomic<bool>& /*stop*/) override {}
    Observation observe() const override {
        Observation seen;
        seen.bobs.resize(2);
        return seen;
    }
    Effort effort() const override { return {.steps = 1, .evaluations = evaluations_}; }

private:
    long evaluations_;
};

TEST(WorkPrecisionChart, OfLibrariesHasTheirFiveBestAndDoppelsBest) {
    // all report no motion, which is correct within 1e-8 for a pendulum almost at rest
    std::vector<ExternalMethod> libraries;
    for (const int cost : {70, 10, 60, 20, 50, 30, 40})
        libraries.push_back(
            {fmt::format("at {}", cost), true, 1e-4, 1e-2,
             [cost](const Pendulum<double>&, double, double) { return std::make_unique<Oracle>(cost); }});
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / fmt::format("still-{}.toml", getpid());
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "[scene]\nduration_s = 1\n[system]\nangle_deg = [1e-7, 0]\n";
    const auto figure = read_figure(
        {"x", "presets/x.toml",
         fmt::format("[scene]\nkind = \"work-precision\"\n[work_precision]\nscene = \"{}\"\n", path.string())},
        sets([] {
            auto arguments = quick;
            arguments.emplace_back("work_precision.methods=[\"rk4\", \"taylor\", \"euler\"]");
            return arguments;
        }()),
        libraries);
    const auto page = page_of(figure);
    const auto labels = labels_of(page.panels[0]);
    for (const int cost : {10, 20, 30, 40, 50}) EXPECT_TRUE(labels.contains(fmt::format("at {}", cost))) << cost;
    EXPECT_EQ(labels.size(), 5u + 1);
    EXPECT_EQ(std::count_if(labels.begin(), labels.end(), [](auto& label) { return label.ends_with(" of Doppel"); }),
              1);
    EXPECT_EQ(faint_ones(page.panels[0]), 2);  // the other libraries' methods, and none of Doppel's
    EXPECT_TRUE(page.captions[0].starts_with("In colour the five best methods of other libraries")) << page.captions[0];
    std::filesystem::remove(path);
}

}  // namespace work_precision_chart_test
}  // namespace doppel

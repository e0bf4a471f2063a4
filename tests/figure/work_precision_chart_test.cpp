#include "figure/support.hpp"
#include "figure/work_precision.hpp"

#include <gtest/gtest.h>

#include <set>

namespace doppel::work_precision_chart_test {

// Which methods a work-precision chart colours.

std::set<std::string> labels_of(const Plot& plot) {
    std::set<std::string> labels;
    for (const auto& curve : plot.curves)
        if (!curve.label.empty()) labels.insert(curve.label);
    return labels;
}

long faint_ones(const Plot& plot) {
    return std::ranges::count(plot.curves, Background::line, &Curve::background);
}

Figure quick_page(std::vector<std::string> sets) {
    sets.insert(sets.end(), {"chart.cost=\"evaluations\"", "work_precision.most_evaluations=5000",
                             "work_precision.models=[\"angles\"]"});
    return page_of(figure_of("speed-accuracy", sets));
}

TEST(WorkPrecisionChart, HasFiveInColour) {
    const auto page = quick_page({"work_precision.problems=[\"P1\", \"P3\"]"});
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
    const auto page = quick_page({"work_precision.problems=[\"P1\"]", "chart.names=\"all\""});
    EXPECT_EQ(faint_ones(page.panels[0]), 0);
    EXPECT_EQ(labels_of(page.panels[0]).size(), 10u + 1);  // methods in angles, and the study's point
}

TEST(WorkPrecisionChart, NamesAllWhereTheyAreFew) {
    const auto page =
        quick_page({"work_precision.problems=[\"P3\"]", "work_precision.methods=[\"rk4\", \"midpoint\"]"});
    EXPECT_EQ(faint_ones(page.panels[0]), 0);
    EXPECT_TRUE(labels_of(page.panels[0]).contains("midpoint"));
    EXPECT_TRUE(page.captions[0].starts_with("Each method in its best model;")) << page.captions[0];
}

TEST(WorkPrecisionChart, SaysFromWhichSpreadOnTimesHaveBars) {
    EXPECT_TRUE(timing_caption({}, 5).ends_with("Bars: where a coloured curve has more than ± 5 %."))
        << timing_caption({}, 5);
    EXPECT_EQ(timing_caption({}, 1), "CPU time of one thread, warm, measured once.");
}

}  // namespace doppel::work_precision_chart_test

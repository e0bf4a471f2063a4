#include "plot/labels.hpp"
#include "plot/plot_figures.hpp"
#include "render/typeface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace doppel::plot_axes_test {

// Shared axes of panels, notes beside a panel's title, line breaks of text, and line widths.

constexpr const Theme& light = themes[1];
constexpr Size size{1200, 900};

/// Two rows of two maps of equal height; if `split`, the lower row has another x axis.
Figure four_maps(bool shares_axes, bool split) {
    Figure figure{.title = "Maps", .columns = 2, .shares_axes = shares_axes};
    for (int i = 0; i < 4; ++i) {
        const double high = split && i >= 2 ? 50 : 10;
        Plot plot{.title = "map", .note = "17 s"};
        plot.x = {.label = high == 10 ? "step, s" : "tolerance", .low = 0, .high = high};
        plot.y = {.label = "angle, °", .low = 0, .high = 180, .every = 90};
        plot.map = HeatMap{.columns = 1, .rows = 1, .values = {1}, .low = 0, .high = 2, .shares_bar = true};
        figure.panels.push_back(plot);
    }
    return figure;
}

/// The areas of the four maps, px².
std::vector<float> areas(const PageList& list) {
    std::vector<float> all;
    for (const auto& cells : images_of(list, true)) all.push_back(cells.within->width() * cells.within->height());
    return all;
}

TEST(Plot, SharedAxesHaveTheirWordsOnce) {
    const auto apart = composed(four_maps(false, false), size, light);
    const auto shared = composed(four_maps(true, false), size, light);
    EXPECT_EQ(words_in(apart)["step, s"], 4);
    EXPECT_EQ(words_in(apart)["angle, °"], 4);
    EXPECT_EQ(words_in(apart)["90"], 4);
    EXPECT_EQ(words_in(shared)["step, s"], 2);   // below each column
    EXPECT_EQ(words_in(shared)["angle, °"], 1);  // above the first panel
    EXPECT_EQ(words_in(shared)["90"], 2);        // beside each row
    // all panels have one size, larger than before
    const auto before = areas(apart), after = areas(shared);
    ASSERT_EQ(after.size(), 4u);
    for (const float area : after) EXPECT_EQ(area, after.front());
    EXPECT_GT(after.front(), 1.1f * before.front());  // measured 1.13
}

TEST(Plot, AxesThatDifferAreNotShared) {
    auto words = words_in(composed(four_maps(true, true), size, light));
    EXPECT_EQ(words["step, s"], 2);
    EXPECT_EQ(words["tolerance"], 2);
    EXPECT_EQ(words["50"], 2);
    EXPECT_EQ(words["angle, °"], 1);
    auto figure = four_maps(true, false);
    figure.panels[1].y.high = 90;
    words = words_in(composed(figure, size, light));
    EXPECT_EQ(words["angle, °"], 2);  // that of the first map, and the one beside it
}

TEST(Plot, AMapBesideOneWithAnotherAxisHasItsOwnWords) {
    auto figure = four_maps(true, false), other = four_maps(true, true);
    figure.panels.insert(figure.panels.begin() + 3, other.panels.begin() + 2, other.panels.end());
    figure.panels.back() = other.panels.back();  // rows: steps; a step and a tolerance; tolerances
    auto words = words_in(composed(figure, size, light));
    EXPECT_EQ(words["step, s"], 2);    // the last of each column
    EXPECT_EQ(words["tolerance"], 3);  // also beside the last step
}

TEST(Plot, CurvesOnSharedAxesHaveOneRange) {
    Figure figure{.columns = 2, .shares_axes = true};
    for (const double maximum : {3.0, 40.0})
        figure.panels.push_back(
            {.x = {.label = "x"}, .y = {.label = "y"}, .curves = {{.x = {0, 1}, .y = {0, maximum}}}});
    auto words = words_in(composed(figure, size, light));
    EXPECT_EQ(words["y"], 1);
    EXPECT_EQ(words["40"], 1);
    EXPECT_EQ(words["3"], 0);
    figure.shares_axes = false;
    EXPECT_EQ(words_in(composed(figure, size, light))["y"], 2);
}

TEST(Plot, ANoteStandsBesideTheTitleWhereThereIsRoom) {
    EXPECT_EQ(words_in(composed(four_maps(true, false), size, light))["17 s"], 4);
    auto figure = four_maps(true, false);
    // the title shrinks a little for the note
    for (auto& plot : figure.panels) plot.title = "a title of a panel that leaves a note no room beside it";
    EXPECT_EQ(words_in(composed(figure, size, light))["17 s"], 4);
    for (auto& plot : figure.panels)
        plot.title = "a title of a panel that is so long that it leaves a note no room at all";
    // where they have no space beside the titles, they are below them
    const auto below = composed(figure, size, light);
    EXPECT_EQ(words_in(below)["17 s"], 4);
    EXPECT_EQ(words_in(below)[figure.panels[0].title], 4);
    for (const auto& text : items_of<Label>(below)) EXPECT_TRUE(text.text != "17 s" || text.align == Align::left);
    // and in low panels they are left out, which is said
    const auto low = compose(figure, {600, 250}, light);
    EXPECT_EQ(words_in(low.items).count("17 s"), 0u);
    ASSERT_FALSE(low.notes.empty());
    EXPECT_EQ(low.notes[0], "there is no space for the notes of panels");
}

/// The width of the longest stroke, px.
float line_width(std::size_t points) {
    Curve curve;
    for (std::size_t i = 0; i < points; ++i) {
        curve.x.push_back(static_cast<double>(i));
        curve.y.push_back(static_cast<double>(i % 7));
    }
    const auto lines = items_of<Polylines>(composed({.panels = {{.curves = {curve}}}}, {1600, 900}, light));
    return std::ranges::max_element(lines, {}, [](const auto& line) { return line.lines[0].size(); })->width;
}

TEST(Plot, LinesOfManyPointsAreThin) {
    EXPECT_FLOAT_EQ(line_width(200), 3.2f);
    EXPECT_FLOAT_EQ(line_width(1000), 2);
}

TEST(Text, LinesEndEvenlyAndNotWithinANumber) {
    const std::string text =
        "It takes 12 464 evaluations at a step of 0.25 s where θ₁ = 45° and one more line of words that goes on and on";
    const auto joined = [](const std::vector<std::string>& lines) {
        return std::accumulate(std::next(lines.begin()), lines.end(), lines.front(),
                               [](const std::string& all, const std::string& line) { return all + ' ' + line; });
    };
    for (float width = 120; width < 900; width += 7) {
        const auto lines = evenly_wrapped(text, 18, Weight::regular, width);
        EXPECT_EQ(joined(lines), text);
        EXPECT_EQ(lines.size(), wrapped(text, 18, Weight::regular, width).size());
        for (const auto& line : lines) {
            EXPECT_LE(text_width(line, 18), width);
            for (const auto* end : {"12", "0.25", "=", "θ₁"}) EXPECT_FALSE(line.ends_with(end)) << line;
        }
    }
    // a text whose last line would be a single word
    const float width = text_width(text, 18) * 0.98f;
    EXPECT_EQ(wrapped(text, 18, Weight::regular, width).back(), "on");
    const auto even = evenly_wrapped(text, 18, Weight::regular, width);
    ASSERT_EQ(even.size(), 2u);
    EXPECT_GT(text_width(even[1], 18), text_width(even[0], 18) / 3);
}

}  // namespace doppel::plot_axes_test

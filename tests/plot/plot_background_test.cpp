#include "plot/plot_figures.hpp"
#include "render/pixels.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::plot_background_test {

// Curves in the background, and labels of many curves.

constexpr const Theme& light = themes[1];
constexpr Size size{800, 500};

/// The share of the pixels of that colour.
double share_of(const Picture& picture, Color color) {
    long count = 0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) count += is_color(picture.at(x, y), color, 1);
    return static_cast<double>(count) / (size.width * size.height);
}

Figure level_line(Background background) {
    Plot plot{.x = {.low = 0, .high = 10}, .y = {.low = 0, .high = 1}};
    plot.curves = {{.label = "background", .x = {0, 10}, .y = {0.5, 0.5}, .background = background}};
    return {.panels = {plot}};
}

TEST(Plot, ABackgroundIsPaleAndHasNoLabel) {
    const auto pale = [](Color color, float share) { return mixed(light.background, color, share); };
    const auto band = composed(level_line(Background::band), size, light);
    EXPECT_EQ(words_in(band).count("background"), 0u);
    // the band is 6 line widths high over 90 % of the width: 6 × 3.2 × 5/9 px of 500
    EXPECT_NEAR(share_of(picture(level_line(Background::band), size, light), pale(light.open, 0.22f)),
                0.9 * 6 * 3.2 * 5 / 9 / 500, 0.005);
    const auto line = composed(level_line(Background::line), size, light);
    EXPECT_EQ(words_in(line).count("background"), 0u);
    const double thin = share_of(picture(level_line(Background::line), size, light), pale(light.palette[0], 0.3f));
    EXPECT_GT(thin, 0.0005);
    EXPECT_LT(thin, 0.003);
}

/// `count` steep lines side by side, too close for labels between them.
Figure fan(int count) {
    Plot plot{.x = {.low = 0, .high = 10}, .y = {.low = 0, .high = 1}};
    for (int i = 0; i < count; ++i) {
        const double foot = 0.2 + 9.6 * i / count;
        plot.curves.push_back(
            {.label = fmt::format("method {}", i), .x = {foot, foot + 0.2}, .y = {0.02, 0.98}, .hue = i});
    }
    return {.panels = {plot}};
}

/// The labels of curves that start with `begin`.
std::vector<Label> labels_of(const PageList& list, std::string_view begin) {
    auto labels = items_of<Label>(list);
    std::erase_if(labels, [&](const Label& label) { return !label.text.starts_with(begin); });
    return labels;
}

TEST(Plot, LabelsOfManyCurvesAreOnTheCurves) {
    constexpr int count = 16;
    const auto labels = labels_of(composed(fan(count), size, light), "method ");
    ASSERT_EQ(labels.size(), static_cast<std::size_t>(count));
    // in the curves' colours: in a legend they would have the text's colour
    for (const auto& label : labels) EXPECT_NE(label.color, light.text) << label.text;
}

TEST(Plot, LabelsHaveOneSizeInAllPanels) {
    auto figure = fan(16);
    figure.panels.push_back(fan(2).panels[0]);
    figure.panels[0].title = "a title that is a good deal longer than one half of the picture is wide, and so shrinks";
    figure.panels[1].title = "title";
    for (const auto* begin : {"method", "title"}) {
        const auto labels = labels_of(composed(figure, size, light), begin);
        ASSERT_FALSE(labels.empty());
        for (const auto& label : labels) EXPECT_EQ(label.size, labels[0].size) << label.text;
    }
    EXPECT_LT(labels_of(composed(figure, size, light), "title")[0].size,
              labels_of(composed({.panels = {{.title = "title"}, {.title = "title"}}}, size, light), "title")[0].size);
}

TEST(Plot, ALegendCoversNoDataAndHasAllNames) {
    // clouds over most of the panel leave no space for a legend; a line above them has space for its label
    auto figure = sections(1);
    auto& panel = figure.panels[0];
    auto& curves = panel.curves;
    for (int k = 1; k < 3; ++k) curves.push_back(curves[0]), curves.back().hue = k;
    for (auto& curve : curves)
        for (std::size_t i = 0; i < curve.x.size(); ++i)
            curve.x[i] = static_cast<double>(i % 27), curve.y[i] = static_cast<double>(i / 27);
    const double top = *std::ranges::max_element(curves[0].y);
    panel.y.high = 1.12 * top;
    curves.push_back({.label = "one orbit's limit", .x = {0, 26}, .y = {1.02 * top, 1.02 * top}});
    const auto list = composed(figure, size, light);
    const auto names = labels_of(list, "one orbit");
    ASSERT_EQ(names.size(), 4u);
    float right = 0;
    for (const auto& image : items_of<Image>(list)) right = std::max(right, image.at.right);
    ASSERT_GT(right, 0);
    for (const auto& name : names) EXPECT_GT(name.anchor.x, right) << name.text;
    // a second panel, which has space for its label, has it beside the panel as well
    auto both = figure;
    both.panels.push_back(panel);
    both.panels[1].curves = {curves.back()};
    const auto in_legends = labels_of(composed(both, size, light), "one orbit");
    ASSERT_EQ(in_legends.size(), 5u);
    for (const auto& name : in_legends) EXPECT_EQ(name.color, light.text) << name.text;
    // by itself the line is labelled in the panel
    panel.curves = {curves.back()};
    EXPECT_LT(labels_of(composed(figure, size, light), "one orbit").at(0).anchor.x, right);
}

TEST(Plot, NamesThatWouldHideOtherCurvesStandInALegendBesideThePanel) {
    // level lines, closer than a line of text
    Plot plot{.x = {.low = 0, .high = 10}, .y = {.low = 0, .high = 1}};
    for (int i = 0; i < 14; ++i)
        plot.curves.push_back({.label = fmt::format("method {}", i), .x = {0, 10}, .y = {0.05 * i, 0.05 * i}});
    plot.curves.push_back({.label = "method alone", .x = {0, 10}, .y = {0.98, 0.98}});
    Page page = compose({.panels = {plot}}, {800, 260}, light);
    const auto names = labels_of(page.items, "method");
    ASSERT_EQ(names.size(), 15u);
    EXPECT_EQ(names.front().text, "method alone");  // in the order of the curves' ends
    EXPECT_EQ(names.back().text, "method 0");
    for (const auto& name : names) EXPECT_GT(name.anchor.x, page.panels[0].x.to) << name.text;
}

TEST(Plot, ARuleOverAMapIsSeenOnAllColors) {
    Figure figure = map(false);
    figure.panels[0].rules = {{Rule::Orientation::vertical, 60, ""}};
    auto upright = items_of<Polylines>(composed(figure, size, light));
    std::erase_if(upright, [](const Polylines& line) { return line.lines[0].size() != 2; });
    ASSERT_EQ(upright.size(), 2u);
    EXPECT_EQ(upright[0].dash, 0);  // dark, below the white dashes
    EXPECT_LT(upright[0].color.r, 0.1f);
    EXPECT_GT(upright[1].dash, 0);
}

TEST(Plot, AMarkAmongManyCurvesHasALeaderLine) {
    auto figure = fan(12);
    auto& curves = figure.panels[0].curves;
    figure.panels[0].y.high = 2;
    curves.insert(curves.begin(), {.label = "where the others stand", .x = {5}, .y = {0.9}, .mark = Mark::points});
    const auto list = composed(figure, size, light);
    EXPECT_EQ(words_in(list).count("where the others stand"), 1u);
    const auto thin = std::ranges::count_if(items_of<Capsule>(list), [](const Capsule& capsule) {
        return capsule.from.y != capsule.to.y && capsule.from.x == capsule.to.x && capsule.radius <= 0.5f;
    });
    EXPECT_EQ(thin, 1);
}

}  // namespace doppel::plot_background_test

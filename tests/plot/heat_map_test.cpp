#include "image/color.hpp"
#include "plot/panel.hpp"
#include "plot/plot_figures.hpp"
#include "render/pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::heat_map_test {

HeatMap strip(std::vector<float> values) {
    return {.columns = values.size(), .rows = 1, .values = values, .label = "an error", .low = 0, .high = 1};
}

/// A map from `low` to `high`, over an axis of 90 px from 1 to 1000 or reversed, with a margin of 5 px.
Picture drawn(const HeatMap& map, double low, double high, bool logarithmic, bool reversed) {
    const Plot plot{.x = {.low = low, .high = high}, .y = {.low = 0, .high = 1}, .map = map};
    Axis x{.low = 1, .high = 1000, .from = 5, .to = 95, .logarithmic = logarithmic};
    if (reversed) std::swap(x.low, x.high);
    const Axis y{.low = 0, .high = 1, .from = 15, .to = 5};
    return picture_of({.size = {100, 20},
                       .items = {filled({100, 20}, rgb(0xffffff)), map_cells(plot, x, y, {5, 5, 95, 15}, themes[1])}});
}

TEST(HeatMap, HasCellsThatAreEvenOnTheirAxes) {
    const auto map = strip({0, 0.5, 1});
    const auto expect_color = [](const Picture& picture, int x, const Color& color) {
        EXPECT_TRUE(is_color(picture.at(x + 5, 10), color, 1)) << x;
    };
    for (const bool logarithmic : {false, true})
        for (const bool reversed : {false, true}) {
            const auto picture = drawn(map, 1, 1000, logarithmic, reversed);
            for (const int cell : {0, 1, 2})
                for (const int x : {30 * cell, 30 * cell + 29})
                    expect_color(picture, reversed ? 89 - x : x, map_color(0.5 * cell));
            for (const int outside : {-1, 90}) expect_color(picture, outside, rgb(0xffffff));
        }
    // one that covers only the middle decade, and one that is cut off
    auto picture = drawn(map, 10, 100, true, false);
    for (const int x : {30, 39, 40, 49, 50, 59}) expect_color(picture, x, map_color(0.5 * ((x - 30) / 10)));
    for (const int outside : {29, 60}) expect_color(picture, outside, rgb(0xffffff));
    picture = drawn(map, 1e-3, 1e3, true, false);
    for (const int x : {0, 29, 30, 89}) expect_color(picture, x, map_color(x < 30 ? 0.5 : 1));
    expect_color(picture, -1, rgb(0xffffff));
}

TEST(HeatMap, ShowsTheMeanWhereCellsAreSmallerThanPixels) {
    auto map = strip({});
    for (int i = 0; i < 2000; ++i) map.values.push_back(i % 2 ? 1.0f : 0.2f);
    map.columns = 2000;
    const auto picture = drawn(map, 1, 1000, true, false);
    for (int x = 7; x < 93; ++x)
        EXPECT_NEAR(picture.at(x, 10)[1], 255 * (map_color(0.2).g + map_color(1).g) / 2, 12) << x;
}

TEST(HeatMap, OfAThresholdHasTwoColors) {
    auto map = strip({0, 0.25f, 0.5f, 1});
    map.threshold = 0.5;
    const auto picture = cell_picture(map, themes[1]);
    const auto same = [&](int one, int other) {
        return std::equal(picture.at(one, 0), picture.at(one, 0) + 4, picture.at(other, 0));
    };
    EXPECT_TRUE(same(0, 1));
    EXPECT_TRUE(same(1, 2));
    EXPECT_FALSE(same(2, 3));
}

TEST(HeatMap, BarNamesTheThreshold) {
    auto map = strip({0, 1});
    for (const double threshold : {0.013, 0.47}) {
        map.threshold = threshold;
        auto words = words_in(composed(
            {.panels = {{.x = {.low = 0, .high = 1}, .y = {.low = 0, .high = 1}, .map = map}}}, {800, 450}, themes[1]));
        EXPECT_GE(words[tick_at(threshold).text], 1) << threshold;
    }
}

TEST(HeatMap, ShowsWhatIsBadInItsColor) {
    auto map = strip({0.5f, std::nanf("")});
    for (const auto& theme : themes) {
        map.none_is_bad = false;
        EXPECT_EQ(none_color(map, theme), theme.none);
        map.none_is_bad = true;
        EXPECT_EQ(none_color(map, theme), theme.bad);
    }
    map.none_label = "blow-up";
    Figure figure{.panels = {{.x = {.low = 0, .high = 1}, .y = {.low = 0, .high = 1}, .map = map}}};
    const auto list = composed(figure, {800, 450}, themes[1]);
    EXPECT_EQ(std::ranges::count(items_of<Box>(list), themes[1].bad, &Box::color), 1);
    const auto cells = images_of(list, true);
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_TRUE(is_color(cells[0].pixels->at(1, 0), themes[1].bad, 1));
}

TEST(HeatMap, SharesItsBar) {
    Figure figure;
    for (const bool shared : {false, true}) {
        auto map = strip({0, 1});
        map.none_label = "blow-up";
        map.shares_bar = shared;
        figure.panels.assign(4, {.x = {.low = 0, .high = 1}, .y = {.low = 0, .high = 1}, .map = map});
        float right = 0, panels_right = 0, bar_left = 1e9f;
        const auto list = composed(figure, {1600, 900}, themes[1]);
        const auto bars = images_of(list, false);
        for (const auto& bar : bars) bar_left = std::min(bar_left, bar.at.left), right = std::max(right, bar.at.right);
        for (const auto& panel : images_of(list, true)) panels_right = std::max(panels_right, panel.within->right);
        auto words = words_in(list);
        for (const int count : {words["blow-up"], words["an error"], static_cast<int>(bars.size())})
            EXPECT_EQ(count, shared ? 1 : 4) << shared;
        EXPECT_LT(right, 1600);
        EXPECT_EQ(bar_left > panels_right, shared);
    }
}

}  // namespace doppel::heat_map_test

#include "image/color.hpp"
#include "plot/chart_parts.hpp"
#include "plot/plot_figures.hpp"
#include "render/pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace heat_map_test {

HeatMap strip(std::vector<float> values) {
    return {.columns = values.size(), .rows = 1, .values = values, .label = "an error", .low = 0, .high = 1};
}

/// Whether the map's uppermost row has that colour `x` px from its left edge.
void expect_color(const Image& image, int x, const Color& color) {
    const int column = x * image.pixels->size.width / static_cast<int>(image.right - image.left);
    EXPECT_TRUE(is_color(image.pixels->at(column, 0), color, 1)) << x;
}

/// 90 px wide, over an axis of 1 to 1000. A map of all of it has a pixel a cell.
Image drawn(const HeatMap& map, bool logarithmic) {
    const Axis x{.low = 1, .high = 1000, .from = 0, .to = 90, .logarithmic = logarithmic};
    const Axis y{.low = 0, .high = 1, .from = 10, .to = 0};
    return map_image(map, {.low = 0, .high = 1}, x, y, {0, 0, 90, 10}, rgb(0xff0000), 1);
}

TEST(HeatMap, HasCellsThatAreEvenOnTheirAxes) {
    auto map = strip({0, 0.5, 1});
    map.x_low = 1, map.x_high = 1000;
    for (const bool logarithmic : {false, true}) {
        const auto image = drawn(map, logarithmic);
        for (const int cell : {0, 1, 2})
            for (const int x : {30 * cell, 30 * cell + 29}) expect_color(image, x, map_color(0.5 * cell));
    }
    // one that covers the middle decade alone
    map.x_low = 10, map.x_high = 100;
    const auto image = drawn(map, true);
    for (const int x : {30, 39, 40, 49, 50, 59}) expect_color(image, x, map_color(0.5 * ((x - 30) / 10)));
    EXPECT_EQ(image.pixels->at(29, 0)[3], 0);
    EXPECT_EQ(image.pixels->at(60, 0)[3], 0);
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
    int swatches = 0, cells = 0;
    for (const auto& item : compose(figure, {800, 450}, themes[1])) {
        if (const auto* box = std::get_if<Box>(&item)) swatches += box->color == themes[1].bad;
        if (const auto* image = std::get_if<Image>(&item))
            if (image->right - image->left > 100) {
                expect_color(*image, static_cast<int>(image->right - image->left) - 2, themes[1].bad);
                ++cells;
            }
    }
    EXPECT_EQ(swatches, 1);
    EXPECT_EQ(cells, 1);
}

TEST(HeatMap, SharesItsBar) {
    Figure figure;
    for (const bool shared : {false, true}) {
        auto map = strip({0, 1});
        map.none_label = "blow-up";
        map.shares_bar = shared;
        figure.panels.assign(4, {.x = {.low = 0, .high = 1}, .y = {.low = 0, .high = 1}, .map = map});
        int bars = 0;
        float right = 0, panels_right = 0, bar_left = 1e9f;
        const auto list = compose(figure, {1600, 900}, themes[1]);
        for (const auto& item : list) {
            const auto* image = std::get_if<Image>(&item);
            if (!image) continue;
            right = std::max(right, image->right);
            if (image->right - image->left < 40) {
                ++bars;
                bar_left = std::min(bar_left, image->left);
            } else {
                panels_right = std::max(panels_right, image->right);
            }
        }
        auto words = words_in(list);
        for (const int count : {words["blow-up"], words["an error"], bars}) EXPECT_EQ(count, shared ? 1 : 4) << shared;
        EXPECT_LT(right, 1600);
        EXPECT_EQ(bar_left > panels_right, shared);
    }
}

}  // namespace heat_map_test
}  // namespace doppel

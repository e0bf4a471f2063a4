#include "image/color.hpp"
#include "plot/plot_figures.hpp"
#include "render/pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace doppel::plot_pixels_test {

constexpr const Theme &dark = themes[0], &light = themes[1];

constexpr Size size{400, 300};

/// A panel with only a map: x from 0 to 10, y from 0 to 1.
Figure bare_map(std::size_t columns, std::size_t rows, bool blank = false) {
    HeatMap map{.columns = columns, .rows = rows, .low = 0.0, .high = 1.0};
    for (std::size_t i = 0; i < columns * rows; ++i)
        map.values.push_back(blank ? std::nanf("") : static_cast<float>(i % 11) / 10);
    return {.panels = {{.x = {.low = 0, .high = 10}, .y = {.low = 0, .high = 1}, .map = map}}};
}

/// A panel without a map, with the same axes.
Figure with_curves(std::vector<Curve> curves) {
    return {.panels = {{.x = {.low = 0, .high = 10}, .y = {.low = 0, .high = 1}, .curves = std::move(curves)}}};
}

/// The area of a map's panel.
Area area_of(const PageList& list) {
    return *images_of(list, true).at(0).within;
}

void expect_color(const Picture& picture, float x, float y, Color color, int tolerance = 1) {
    const std::uint8_t* pixel = picture.at(static_cast<int>(x), static_cast<int>(y));
    EXPECT_TRUE(is_color(pixel, color, tolerance))
        << x << " " << y << ": " << int(pixel[0]) << " " << int(pixel[1]) << " " << int(pixel[2]);
}

TEST(Plot, MapCellsHaveTheirColours) {
    const PageList list = composed(bare_map(7, 5), size, light);
    const Picture drawn = picture(bare_map(7, 5), size, light);
    const Area area = area_of(list);
    ASSERT_GT(area.right - area.left, 200);
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 7; ++column)
            expect_color(drawn, std::lerp(area.left, area.right, (static_cast<float>(column) + 0.5f) / 7),
                         std::lerp(area.bottom, area.top, (static_cast<float>(row) + 0.5f) / 5),
                         map_color((row * 7 + column) % 11 / 10.0));
    // a cell without a value has its own colour
    const PageList none = composed(bare_map(3, 3, true), size, dark);
    const Area where = area_of(none);
    expect_color(picture(bare_map(3, 3, true), size, dark), where.left + 50, where.top + 50, dark.none);
}

TEST(Plot, ACurvePassesWhereItsValuesAre) {
    for (const bool logarithmic : {false, true}) {
        Figure figure = bare_map(1, 1, true);
        Plot& plot = figure.panels[0];
        if (logarithmic) plot.y = {.low = 1e-4, .high = 1, .logarithmic = true};
        const Area area = area_of(composed(figure, size, light));
        plot.curves = {
            {.x = {0, 10}, .y = logarithmic ? std::vector{1e-4, 1.0} : std::vector{0.0, 1.0}, .quiet = true}};
        const Picture drawn = picture(figure, size, light);
        // on either axis a straight line from corner to corner; a quiet line over a map is white
        for (const float part : {0.1f, 0.35f, 0.5f, 0.81f})
            expect_color(drawn, std::lerp(area.left, area.right, part), std::lerp(area.bottom, area.top, part),
                         rgb(0xffffff), 40);
        expect_color(drawn, std::lerp(area.left, area.right, 0.2f), std::lerp(area.top, area.bottom, 0.2f), light.none);
    }
}

struct Reach {
    float left = 1e9f, top = 1e9f, right = -1e9f, bottom = -1e9f;
};

/// The extent of all strokes in a colour, px.
Reach reach(const PageList& list, Color color) {
    Reach all;
    for (const auto& stroke : items_of<Polylines>(list))
        for (const auto& line : stroke.lines)
            for (const Point at : line) {
                if (!(stroke.color == color)) continue;
                all.left = std::min(all.left, at.x), all.right = std::max(all.right, at.x);
                all.top = std::min(all.top, at.y), all.bottom = std::max(all.bottom, at.y);
            }
    return all;
}

TEST(Plot, CurvesAreCutAtThePanel) {
    Figure figure = bare_map(1, 1, true);
    const Area area = area_of(composed(figure, size, light));
    Curve wild{.hue = 3};
    std::mt19937 random(5);
    for (int i = 0; i < 2000; ++i) {
        wild.x.push_back(std::normal_distribution<double>(5, 9)(random));
        wild.y.push_back(std::pow(10, std::normal_distribution<double>(0, 60)(random)));
    }
    figure.panels[0].curves = {wild};
    const Reach held = reach(composed(figure, size, light), dark.palette[3]);
    EXPECT_GE(held.left, area.left - 0.01f);
    EXPECT_GE(held.top, area.top - 0.01f);
    EXPECT_LE(held.right, area.right + 0.01f);
    EXPECT_LE(held.bottom, area.bottom + 0.01f);
    EXPECT_GT(held.right - held.left, 0.99f * (area.right - area.left));

    // the curve enters at the bottom after a third of the way and leaves at the top after two thirds
    figure.panels[0].curves = {{.x = {0, 10}, .y = {-1, 2}, .hue = 3}};
    const Reach cut = reach(composed(figure, size, light), dark.palette[3]);
    EXPECT_NEAR(cut.left, std::lerp(area.left, area.right, 1 / 3.0f), 0.01f);
    EXPECT_NEAR(cut.right, std::lerp(area.left, area.right, 2 / 3.0f), 0.01f);
}

TEST(Plot, ReducingManyPointsDoesNotChangeThePicture) {
    Figure dense, sparse;
    dense.panels = {{.x = {.low = 0, .high = 1}, .y = {.low = -2, .high = 2}}};
    Curve wave{.hue = 1};
    constexpr int points = 100000;
    for (int i = 0; i <= points; ++i) {
        wave.x.push_back(static_cast<double>(i) / points);
        wave.y.push_back(std::sin(40 * wave.x.back()) + 0.4 * std::sin(3000 * wave.x.back()));
    }
    sparse = dense;
    dense.panels[0].curves = {wave};
    // pieces so short that each one is drawn in full
    for (int from = 0; from < points; from += 500) {
        Curve piece{.hue = 1};
        for (int i = from; i <= from + 500; ++i) {
            piece.x.push_back(wave.x[static_cast<std::size_t>(i)]);
            piece.y.push_back(wave.y[static_cast<std::size_t>(i)]);
        }
        sparse.panels[0].curves.push_back(piece);
    }
    std::size_t vertices = 0;
    for (const auto& stroke : items_of<Polylines>(composed(dense, size, light)))
        for (const auto& line : stroke.lines) vertices += line.size();
    EXPECT_LT(vertices, 8u * 400 + 10);
    const Picture thin = picture(dense, size, light), full = picture(sparse, size, light);
    int differ = 0;
    for (std::size_t i = 0; i < thin.rgba.size(); ++i) differ += std::abs(thin.rgba[i] - full.rgba[i]) > 60;
    EXPECT_LT(differ, 60);  // channels by more than 60 of 255, of 480 000; measured 16
}

TEST(Plot, WhatIsNoNumberInterruptsTheLine) {
    auto figure = with_curves({{.x = {0, 1, 2, 3, 4, 5, 6, 7, 8}, .y = {.1, .1, -1, .1, .1, std::nan(""), .1, 0, .1}}});
    figure.panels[0].y = {.low = 1e-3, .high = 1, .logarithmic = true};
    const auto list = composed(figure, size, light);
    std::size_t pieces = 0;
    for (const auto& stroke : items_of<Polylines>(list)) pieces += stroke.lines.size();
    EXPECT_EQ(pieces, 2u);
    EXPECT_EQ(items_of<Capsule>(list).size(), 2u) << "what stands alone between gaps shows as a dot";
}

TEST(Plot, ABandIsTintedBetweenItsEdges) {
    auto figure = with_curves({{.x = {-5, 15}, .y = {0.5, 0.5}, .uncertainty = {0.25, 0.25}, .hue = 1}});
    const Area area = area_of(composed(bare_map(1, 1), size, light));
    const auto drawn = picture(figure, size, light);
    const auto at = [&](float share) { return std::lerp(area.bottom, area.top, share); };
    const float x = std::lerp(area.left, area.right, 0.53f);  // not on a grid line
    const Color tinted = mixed(light.background, light.palette[1], 0.2f);
    for (const float inside : {0.27f, 0.46f, 0.73f}) expect_color(drawn, x, at(inside), tinted, 2);
    for (const float outside : {0.23f, 0.77f}) expect_color(drawn, x, at(outside), light.background, 2);
    expect_color(drawn, size.width - 6, at(0.46f), light.background, 2);  // clipped at the panel
}

TEST(Plot, ColorsRepeatDashed) {
    std::vector<Curve> curves;
    for (int hue = 0; hue < 10; ++hue) curves.push_back({.x = {0, 10}, .y = {0.1 * hue, 0.1 * hue}, .hue = hue});
    const auto lines = items_of<Polylines>(composed(with_curves(curves), {800, 450}, themes[1]));
    ASSERT_EQ(lines.size(), curves.size());
    for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i].dash > 0, i >= 8) << i;
}

}  // namespace doppel::plot_pixels_test

#include "errors.hpp"
#include "image/picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace doppel {
namespace reduce_test {

using Pixel = std::array<int, 4>;

Picture filled(Size size, Pixel colour) {
    Picture picture(size);
    for (std::size_t i = 0; i < picture.rgba.size(); ++i) picture.rgba[i] = static_cast<std::uint8_t>(colour[i % 4]);
    return picture;
}
void put(Picture& picture, int x, int y, Pixel colour) {
    for (std::size_t c = 0; c < 4; ++c) picture.at(x, y)[c] = static_cast<std::uint8_t>(colour[c]);
}
Pixel pixel(const Picture& picture, int x, int y) {
    const auto* p = picture.at(x, y);
    return {p[0], p[1], p[2], p[3]};
}

constexpr Pixel black{0, 0, 0, 255}, white{255, 255, 255, 255};

/// The sRGB value of a share of white in black: the inverse of IEC 61966-2-1's curve.
int grey(double share) {
    return static_cast<int>(
        std::lround(255 * (share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1 / 2.4) - 0.055)));
}

TEST(Reduce, MeansAreThoseOfLinearLight) {
    Picture checks({4, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) put(checks, x, y, (x + y) % 2 ? white : black);
    EXPECT_EQ(grey(0.5), 188);  // the standard value; 128 would be the mean of the bytes
    const Picture half = downscaled(checks, {2, 2});
    for (int k = 0; k < 4; ++k) EXPECT_EQ(pixel(half, k % 2, k / 2), (Pixel{188, 188, 188, 255}));

    // one white pixel in 10×6, at any place, is 1/60 of the area
    for (int k = 0; k < 60; ++k) {
        Picture dot = filled({10, 6}, black);
        put(dot, k % 10, k / 10, white);
        EXPECT_EQ(pixel(downscaled(dot, {1, 1}), 0, 0)[1], grey(1 / 60.0));
    }
}

TEST(Reduce, PartsOfPixelsCountByWhatIsCovered) {
    // 5 columns to 2: both share the middle one
    Picture stripe = filled({5, 3}, black);
    for (int y = 0; y < 3; ++y) put(stripe, 2, y, white);
    const Picture two = downscaled(stripe, {2, 3});
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 2; ++x) EXPECT_EQ(pixel(two, x, y)[0], grey(0.5 / 2.5));
    // 3 rows to 2: an edge inside a pixel
    Picture edge = filled({1, 3}, white);
    put(edge, 0, 0, black);
    EXPECT_EQ(pixel(downscaled(edge, {1, 2}), 0, 0)[2], grey(0.5 / 1.5));
    EXPECT_EQ(pixel(downscaled(edge, {1, 2}), 0, 1)[2], 255);
}

TEST(Reduce, FlatStaysFlatAndTheSameSizeIsTheSame) {
    for (int v = 0; v < 256; ++v) {
        const Pixel colour{v, 255 - v, v / 2, 255};
        EXPECT_EQ(downscaled(filled({7, 5}, colour), {3, 2}).rgba, filled({3, 2}, colour).rgba);
    }
    Picture all({16, 16});
    for (int i = 0; i < 256; ++i) put(all, i % 16, i / 16, {i, 255 - i, i ^ 85, 255});
    EXPECT_EQ(downscaled(all, {16, 16}).rgba, all.rgba);
}

TEST(Reduce, WhatIsTransparentHasNoColour) {
    Picture edge({2, 1});
    put(edge, 0, 0, {200, 100, 50, 255});
    put(edge, 1, 0, {0, 255, 0, 0});
    EXPECT_EQ(pixel(downscaled(edge, {1, 1}), 0, 0), (Pixel{200, 100, 50, 128}));
    put(edge, 0, 0, {9, 9, 9, 0});
    EXPECT_EQ(pixel(downscaled(edge, {1, 1}), 0, 0), (Pixel{0, 0, 0, 0}));
}

TEST(Reduce, NeverEnlarges) {
    for (const Size size : {Size{3, 2}, Size{2, 3}, Size{0, 1}, Size{1, -1}}) {
        const auto [code, message] = test::thrown_by([&] { downscaled(filled({2, 2}, white), size); });
        EXPECT_EQ(code, ExitCode::bad_input) << size.width << "x" << size.height;
        EXPECT_NE(message.find("1x1 … 2x2 is possible"), std::string::npos) << message;
    }
}

TEST(ContactSheet, HasEachPictureInItsPlace) {
    std::vector<Picture> pictures;
    for (int k = 0; k < 5; ++k) pictures.push_back(filled({4, 2}, {10 * k, 0, 200, 255}));
    const Picture sheet = contact_sheet(pictures, 3, 2, rgb(0x102030));
    ASSERT_EQ(sheet.size, (Size{2 + 3 * 6, 2 + 2 * 4}));
    for (int y = 0; y < sheet.size.height; ++y)
        for (int x = 0; x < sheet.size.width; ++x) {
            // the index from division, not from copying: column and row of the cell, and the position in it
            const int column = x / 6, row = y / 4, k = 3 * row + column;
            const bool inside = x % 6 >= 2 && y % 4 >= 2 && column < 3 && row < 2 && k < 5;
            EXPECT_EQ(pixel(sheet, x, y), (inside ? Pixel{10 * k, 0, 200, 255} : Pixel{16, 32, 48, 255}));
        }
    EXPECT_EQ(contact_sheet(std::span(pictures).first(2), 3, 0, rgb(0)).size, (Size{8, 2}));
}

TEST(ContactSheet, RefusesWhatItCannotPlace) {
    const std::vector<Picture> unlike{filled({4, 2}, white), filled({2, 4}, white)};
    EXPECT_THROW(contact_sheet({}, 3, 2, rgb(0)), Error);
    EXPECT_THROW(contact_sheet(unlike, 3, 2, rgb(0)), Error);
    EXPECT_THROW(contact_sheet(std::span(unlike).first(1), 0, 2, rgb(0)), Error);
    EXPECT_THROW(contact_sheet(std::span(unlike).first(1), 1, -1, rgb(0)), Error);
}

}  // namespace reduce_test
}  // namespace doppel

#include "image/picture.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace doppel::reduce_test {

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
    const Picture half = halved(checks);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(pixel(half, k % 2, k / 2), (Pixel{188, 188, 188, 255}));

    // one white pixel of four, at any place
    for (int k = 0; k < 4; ++k) {
        Picture dot = filled({2, 2}, black);
        put(dot, k % 2, k / 2, white);
        EXPECT_EQ(pixel(halved(dot), 0, 0)[1], grey(0.25));
    }
}

TEST(Reduce, BeyondAnOddSideItIsTransparent) {
    const Picture half = halved(filled({5, 3}, {200, 100, 50, 255}));
    ASSERT_EQ(half.size, (Size{3, 2}));
    EXPECT_EQ(pixel(half, 0, 0), (Pixel{200, 100, 50, 255}));
    EXPECT_EQ(pixel(half, 2, 0), (Pixel{200, 100, 50, 128}));
    EXPECT_EQ(pixel(half, 1, 1), (Pixel{200, 100, 50, 128}));
    EXPECT_EQ(pixel(half, 2, 1), (Pixel{200, 100, 50, 64}));
}

TEST(Reduce, FlatStaysFlat) {
    for (int v = 0; v < 256; ++v) {
        const Pixel colour{v, 255 - v, v / 2, 255};
        EXPECT_EQ(halved(filled({6, 4}, colour)).rgba, filled({3, 2}, colour).rgba);
    }
}

TEST(Reduce, WhatIsTransparentHasNoColour) {
    Picture edge({2, 2});
    for (int y = 0; y < 2; ++y) put(edge, 0, y, {200, 100, 50, 255}), put(edge, 1, y, {0, 255, 0, 0});
    EXPECT_EQ(pixel(halved(edge), 0, 0), (Pixel{200, 100, 50, 128}));
    for (int y = 0; y < 2; ++y) put(edge, 0, y, {9, 9, 9, 0});
    EXPECT_EQ(pixel(halved(edge), 0, 0), (Pixel{0, 0, 0, 0}));
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

}  // namespace doppel::reduce_test

#include "image/picture.hpp"
#include "render/pixels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::matte_test {

/// A colour with opacity over a grey background in sRGB, as viewers do it.
int over(int color, int opacity, int ground) {
    return static_cast<int>(std::lround((color * opacity + ground * (255 - opacity)) / 255.0));
}

TEST(Matte, FindsTheColourAndOpacityThatWereLaidOver) {
    Picture black({256, 3}), white({256, 3}), found({256, 3});
    constexpr int color[3][3] = {{255, 166, 64}, {0, 0, 0}, {200, 200, 200}};
    for_each_pixel(found, [&](int x, int y) {
        for (int k = 0; k < 4; ++k) {
            black.at(x, y)[k] = static_cast<std::uint8_t>(k == 3 ? 255 : over(color[y][k], x, 0));
            white.at(x, y)[k] = static_cast<std::uint8_t>(k == 3 ? 255 : over(color[y][k], x, 255));
        }
    });
    matte(black, white, {0, 0, 256, 3}, found);
    for_each_pixel(found, [&](int x, int y) {
        const auto* pixel = found.at(x, y);
        EXPECT_NEAR(pixel[3], x, 1) << y;  // measured 1: three roundings of three channels
        for (int k = 0; k < 3; ++k) {
            // the viewer's result on both backgrounds
            EXPECT_NEAR(over(pixel[k], pixel[3], 0), black.at(x, y)[k], 1);
            EXPECT_NEAR(over(pixel[k], pixel[3], 255), white.at(x, y)[k], 2);
        }
    });
}

TEST(Matte, TouchesNothingOutsideItsRectangle) {
    Picture black({4, 4}), white({4, 4}), found({4, 4});
    std::fill(white.rgba.begin(), white.rgba.end(), std::uint8_t{255});
    std::fill(found.rgba.begin(), found.rgba.end(), std::uint8_t{77});
    matte(black, white, {1, 1, 3, 3}, found);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_EQ(found.at(x, y)[3], x >= 1 && x < 3 && y >= 1 && y < 3 ? 0 : 77) << x << ' ' << y;
}

}  // namespace doppel::matte_test

#include "render/pixels.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace doppel::shapes_test {

constexpr Size size{96, 80};

TEST(Disc, LiesWhereItShouldAndIsAsLarge) {
    Renderer renderer(size, {filled(size, black)});
    for (const float radius : {7.3f, 11.0f, 21.5f}) {
        for (const Point at : {Point{40, 38}, Point{40.5f, 38.5f}, Point{41.3f, 37.8f}}) {
            const Ink seen = ink(renderer.draw({Capsule{at, at, radius, white}}));
            EXPECT_NEAR(seen.x, at.x, 0.05);  // measured 0.0057
            EXPECT_NEAR(seen.y, at.y, 0.05);
            const double area = std::numbers::pi * radius * radius;
            EXPECT_NEAR(seen.area / area, 1, 0.005);  // measured 0.0019; a soft edge adds π/12 px²
        }
    }
}

TEST(Disc, IsExactlyItsColourInside) {
    const Color color = rgb(0x4fb0ff);
    const Picture picture = drawn(size, {Capsule{{40, 30}, {40, 30}, 10, color}});
    for (const Point at : {Point{40, 30}, {34, 30}, {40, 37}, {45, 35}})
        EXPECT_TRUE(is_color(picture, at, color, 0)) << at.x << ' ' << at.y;
}

TEST(Box, OnWholePixelsHasNoFringe) {
    for (const Box box : {Box{10, 20, 50, 60, 0, white}, Box{3, 4, 4, 70, 0, white}, Box{0, 0, 96, 1, 0, white}}) {
        const Picture picture = drawn(size, {box});
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const auto px = static_cast<float>(x), py = static_cast<float>(y);
                const bool inside = px >= box.left && px < box.right && py >= box.top && py < box.bottom;
                ASSERT_EQ(picture.at(x, y)[1], inside ? 255 : 0) << x << ' ' << y;
            }
    }
}

TEST(Box, CoversPartsOfPixelsAndRoundsItsCorners) {
    const Picture halves = drawn(size, {Box{10.5f, 10.25f, 20.5f, 20.25f, 0, white}});
    EXPECT_NEAR(halves.at(10, 15)[0], 127.5, 1);
    EXPECT_NEAR(halves.at(20, 15)[0], 127.5, 1);
    EXPECT_NEAR(halves.at(15, 10)[0], 191.25, 1);
    // the area is that of the rectangle less the missing corners
    const Ink round = ink(drawn(size, {Box{10, 10, 60, 50, 12, white}}));
    EXPECT_NEAR(round.area, 50 * 40 - (4 - std::numbers::pi) * 144, 1.5);  // measured 0.98
}

TEST(Box, ThinnerThanAPixelIsFainter) {
    EXPECT_NEAR(ink(drawn(size, {Box{10, 20.4f, 70, 20.6f, 0, white}})).area, 12, 0.1);             // measured 1e-14
    EXPECT_NEAR(ink(drawn(size, {Capsule{{10, 20.5f}, {70, 20.5f}, 0.1f, white}})).area, 12, 0.1);  // measured 0.04
}

TEST(Capsule, IsSymmetric) {
    // point symmetry about the centre of the picture
    const Picture picture = drawn(size, {Capsule{{20, 25}, {76, 55}, 6.5f, white}});
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            // measured 0
            ASSERT_NEAR(picture.at(x, y)[0], picture.at(size.width - 1 - x, size.height - 1 - y)[0], 1);
        }
    }
    const double area = std::numbers::pi * 6.5 * 6.5 + 13 * std::hypot(56.0, 30.0);
    EXPECT_NEAR(ink(picture).area / area, 1, 0.005);  // measured 0.00009
}

TEST(Ring, IsHollowAndItsPenIsAsWide) {
    const Picture picture = drawn(size, {Ring{{48, 40}, 25, 4, white}});
    for (const int right : {0, 21, 25, 28}) EXPECT_EQ(picture.at(48 + right, 40)[0], right == 25 ? 255 : 0) << right;
    EXPECT_NEAR(ink(picture).area / (2 * std::numbers::pi * 25 * 4), 1, 0.005);  // measured 0.0009
}

TEST(Shapes, BlendInTheOrderOfTheList) {
    const Picture picture = drawn(size, {filled(size, rgb(0xff0000)), filled(size, rgb(0x0000ff).with_alpha(0.25f))});
    EXPECT_NEAR(picture.at(5, 5)[0], 191, 1);
    EXPECT_NEAR(picture.at(5, 5)[2], 64, 1);
}

TEST(Shapes, WithoutInkDrawNothing) {
    const float none = std::nanf("");
    const Picture picture =
        drawn(size, {Box{10, 10, 10, 30, 0, white}, Box{30, 30, 20, 40, 0, white}, Capsule{{5, 5}, {9, 9}, 0, white},
                     Capsule{{none, 5}, {9, 9}, 3, white}, Ring{{20, 20}, 5, 0, white}, Stroke{}, Label{}});
    EXPECT_EQ(ink(picture).area, 0);
}

}  // namespace doppel::shapes_test

#include "render/pixels.hpp"
#include "render/renderer.hpp"

#include <gtest/gtest.h>

#include <random>

namespace doppel {
namespace image_test {

constexpr Size size{160, 120};

/// Opaque.
std::shared_ptr<Picture> noise(Size texels, unsigned seed) {
    auto picture = std::make_shared<Picture>(texels);
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < picture->rgba.size(); ++i)
        picture->rgba[i] = i % 4 == 3 ? 255 : static_cast<std::uint8_t>(random());
    return picture;
}

class ImageTest : public testing::Test {
protected:
    Renderer renderer{size, {filled(size, black)}};
};

TEST_F(ImageTest, IsDrawnTexelForTexelAndStaysCrispWhereItIsEnlarged) {
    for (const int scale : {1, 30}) {
        const auto pixels = noise({scale == 1 ? 70 : 4, scale == 1 ? 50 : 3}, 1);
        const Rect r{10, 20, 10 + scale * pixels->size.width, 20 + scale * pixels->size.height};
        const Picture& drawn =
            renderer.draw({Image{static_cast<float>(r.left), static_cast<float>(r.top), static_cast<float>(r.right),
                                 static_cast<float>(r.bottom), pixels}});
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const bool inside = x >= r.left && x < r.right && y >= r.top && y < r.bottom;
                for (int c = 0; c < 3; ++c)
                    ASSERT_EQ(drawn.at(x, y)[c], inside ? pixels->at((x - r.left) / scale, (y - r.top) / scale)[c] : 0)
                        << x << " " << y << ", × " << scale;
            }
    }
}

TEST_F(ImageTest, IsAsOpaqueAsItsTexels) {
    auto pixels = std::make_shared<Picture>(Size{2, 1});
    pixels->rgba = {255, 255, 255, 128, 255, 255, 255, 0};
    const Picture& drawn = renderer.draw({Image{0, 0, 160, 120, pixels}});
    EXPECT_NEAR(drawn.at(40, 60)[0], 128, 1);
    EXPECT_EQ(drawn.at(120, 60)[0], 0);
}

TEST_F(ImageTest, LiesBetweenWhatIsBelowAndAbove) {
    const auto grey = std::make_shared<Picture>(Size{1, 1});
    std::const_pointer_cast<Picture>(grey)->rgba = {100, 100, 100, 255};
    const Label words{.text = "H", .anchor = {70, 90}, .size = 60, .color = white};
    const Picture& drawn = renderer.draw({Box{0, 0, 160, 120, 0, white}, Image{20, 20, 140, 100, grey}, words});
    EXPECT_EQ(drawn.at(5, 5)[0], 255);
    EXPECT_EQ(drawn.at(30, 30)[0], 100);
    EXPECT_EQ(drawn.at(78, 70)[0], 255) << "the stem of the H";
}

TEST_F(ImageTest, WithoutPixelsIsNothing) {
    const Picture& drawn =
        renderer.draw({Image{10, 10, 60, 60, nullptr}, Image{10, 10, 60, 60, std::make_shared<Picture>()},
                       Image{60, 10, 10, 60, noise({2, 2}, 1)}});
    EXPECT_TRUE(extent(drawn).empty());
}

}  // namespace image_test
}  // namespace doppel

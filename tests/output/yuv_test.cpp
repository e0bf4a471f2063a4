#include "output/yuv.hpp"

#include "output/fixtures.hpp"

extern "C" {
#include <libswscale/swscale.h>
}

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

using namespace doppel;
using namespace doppel::test;

namespace {

struct Exact {
    double y, cb, cr;
};

/// ITU-R BT.709-6 in double: E = Kr R + Kg G + Kb B, and the differences of B and R from it.
Exact exact(double r, double g, double b) {
    const double e = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    return {16 + 219 * e / 255, 128 + 224 * (b - e) / 1.8556 / 255, 128 + 224 * (r - e) / 1.5748 / 255};
}

}  // namespace

TEST(Yuv, IsTheExactFormulaRounded) {
    const Size size{512, 256};
    const Picture picture = noise(size, 1);
    const YuvPart part = convert(picture, {0, 0, size.width, size.height});
    double worst_luma = 0.0, worst_chroma = 0.0;
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const std::uint8_t* p = picture.at(x, y);
            worst_luma = std::max(worst_luma, std::abs(exact(p[0], p[1], p[2]).y - part.y()[y * size.width + x]));
        }
    for (int y = 0; y < size.height / 2; ++y)
        for (int x = 0; x < size.width / 2; ++x) {
            double mean[3];
            for (int c = 0; c < 3; ++c)
                mean[c] = (picture.at(2 * x, 2 * y)[c] + picture.at(2 * x + 1, 2 * y)[c] +
                           picture.at(2 * x, 2 * y + 1)[c] + picture.at(2 * x + 1, 2 * y + 1)[c]) /
                          4.0;
            const Exact e = exact(mean[0], mean[1], mean[2]);
            const int i = y * size.width / 2 + x;
            worst_chroma = std::max({worst_chroma, std::abs(e.cb - part.cb()[i]), std::abs(e.cr - part.cr()[i])});
        }
    // rounding alone costs 0.5; the coefficients' 16 bits add the rest
    EXPECT_LT(worst_luma, 0.504);    // measured 0.5012
    EXPECT_LT(worst_chroma, 0.504);  // measured 0.5007
}

TEST(Yuv, GreysAndPrimariesAreTheStandards) {
    const auto of = [](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
        Picture picture({2, 2});
        for (int i = 0; i < 4; ++i)
            std::copy_n(std::initializer_list<std::uint8_t>{r, g, b, 0}.begin(), 4, &picture.rgba[4 * i]);
        const YuvPart part = convert(picture, {0, 0, 2, 2});
        return std::vector<int>{part.y()[0], *part.cb(), *part.cr()};
    };
    for (int grey = 0; grey < 256; ++grey) {
        const auto v = static_cast<std::uint8_t>(grey);
        EXPECT_EQ(of(v, v, v), (std::vector<int>{static_cast<int>(std::lround(16 + grey * 219 / 255.0)), 128, 128}));
    }
    // Poynton, Digital Video and HD, 75 % and 100 % colour bars
    EXPECT_EQ(of(255, 0, 0), (std::vector<int>{63, 102, 240}));
    EXPECT_EQ(of(0, 255, 0), (std::vector<int>{173, 42, 26}));
    EXPECT_EQ(of(0, 0, 255), (std::vector<int>{32, 240, 118}));
}

TEST(Yuv, AgreesWithSwscale) {
    const Size size{640, 360};
    Picture picture = noise(size, 2);
    // swscale filters chroma over more than 2x2 pixels: let those be alike, and the pictures smooth
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            std::uint8_t* p = picture.at(x, y);
            p[0] = static_cast<std::uint8_t>(x * 255 / size.width);
            p[1] = static_cast<std::uint8_t>(y * 255 / size.height);
            p[2] = static_cast<std::uint8_t>((x + y) * 255 / (size.width + size.height));
        }
    const std::unique_ptr<SwsContext, void (*)(SwsContext*)> sws(
        sws_getContext(size.width, size.height, AV_PIX_FMT_RGBA, size.width, size.height, AV_PIX_FMT_YUV420P,
                       SWS_AREA | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP, nullptr, nullptr,
                       nullptr),
        sws_freeContext);
    ASSERT_TRUE(sws);
    const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(sws.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
    YuvPart theirs({0, 0, size.width, size.height});
    const std::uint8_t* from[] = {picture.rgba.data()};
    const int from_stride[] = {4 * size.width};
    std::uint8_t* to[] = {theirs.y(), theirs.cb(), theirs.cr()};
    const int to_stride[] = {size.width, size.width / 2, size.width / 2};
    ASSERT_EQ(sws_scale(sws.get(), from, from_stride, 0, size.height, to, to_stride), size.height);

    const YuvPart ours = convert(picture, {0, 0, size.width, size.height});
    int worst = 0;
    for (int i = 0; i < size.width * size.height * 3 / 2; ++i)
        worst = std::max(worst, std::abs(ours.samples[i] - theirs.samples[i]));
    EXPECT_LE(worst, 1);  // measured 1
}

TEST(Yuv, AnyCoverByAreasGivesTheBytesOfTheWhole) {
    const Size size{322, 178};
    const Picture picture = noise(size, 3);
    const YuvPart all = convert(picture, {0, 0, size.width, size.height});
    std::mt19937 random(4);
    const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int trial = 0; trial < 300; ++trial) {
        const int left = upto(size.width), top = upto(size.height);
        const Rect asked{left, top, left + 1 + upto(size.width - left), top + 1 + upto(size.height - top)};
        const YuvPart part = convert(picture, asked);
        const Rect a = part.area;
        ASSERT_TRUE(a.left <= asked.left && a.right >= asked.right && a.top <= asked.top && a.bottom >= asked.bottom);
        ASSERT_TRUE(asked.left - a.left < 2 && a.right - asked.right < 2 && a.left % 2 == 0 && a.right % 2 == 0);
        for (int y = 0; y < part.height(); ++y)
            ASSERT_TRUE(std::equal(part.y() + y * part.width(), part.y() + (y + 1) * part.width(),
                                   all.y() + (a.top + y) * size.width + a.left));
        for (int y = 0; y < part.height() / 2; ++y)
            for (const auto& [mine, whole] : {std::pair{part.cb(), all.cb()}, std::pair{part.cr(), all.cr()}}) {
                const std::uint8_t* row = mine + y * part.width() / 2;
                ASSERT_TRUE(
                    std::equal(row, row + part.width() / 2, whole + (a.top / 2 + y) * size.width / 2 + a.left / 2));
            }
    }
}

TEST(Yuv, AreasBeyondThePictureAreCutToIt) {
    EXPECT_EQ(even({-3, -1, 1, 1}, {8, 6}), (Rect{0, 0, 2, 2}));
    EXPECT_EQ(even({5, 3, 99, 99}, {8, 6}), (Rect{4, 2, 8, 6}));
}

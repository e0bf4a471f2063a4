#include "output/samples.hpp"

#include "output/fixtures.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace doppel::samples_test {

using namespace test;

constexpr std::array all_samples{AV_PIX_FMT_YUV420P,  AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV420P10LE,
                                 AV_PIX_FMT_YUVA420P, AV_PIX_FMT_RGB24,   AV_PIX_FMT_RGBA};

std::vector<std::uint8_t> bytes_of_area(const Picture& picture, const Rect& area, AVPixelFormat format) {
    std::vector<std::uint8_t> bytes(byte_count(format, area));
    convert(picture, area, format, bytes.data());
    return bytes;
}

/// The samples of a picture, for each plane.
std::vector<std::vector<int>> planes_of(const Picture& picture, AVPixelFormat format) {
    const Rect all{0, 0, picture.size.width, picture.size.height};
    const auto bytes = bytes_of_area(picture, all, format);
    std::vector<std::vector<int>> planes;
    const std::uint8_t* next = bytes.data();
    for (int k = 0; k < av_pix_fmt_count_planes(format); ++k) {
        const auto place = plane_area(format, k, all);
        std::vector<int> plane;
        for (const auto* end = next + place.row_bytes * place.rows; next < end; ++next) {
            plane.push_back(*next);
            if (format == AV_PIX_FMT_YUV420P10LE) plane.back() |= *++next << 8;
        }
        planes.push_back(plane);
    }
    return planes;
}

struct Exact {
    double y, cb, cr;
};

/// ITU-R BT.709-6 in double: E = Kr R + Kg G + Kb B, and the differences B − E and R − E.
Exact exact(double r, double g, double b, double scale) {
    const double e = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    return {scale * (16 + 219 * e / 255), scale * (128 + 224 * (b - e) / 1.8556 / 255),
            scale * (128 + 224 * (r - e) / 1.5748 / 255)};
}

/// The same for the mean of by×by pixels.
Exact exact_mean(const Picture& picture, int x, int y, int by, double scale) {
    double mean[3] = {};
    for (int i = 0; i < by * by; ++i)
        for (int c = 0; c < 3; ++c) mean[c] += picture.at(x + i % by, y + i / by)[c] / double(by * by);
    return exact(mean[0], mean[1], mean[2], scale);
}

TEST(Samples, AreTheExactFormulaRounded) {
    for (const AVPixelFormat format :
         {AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV444P, AV_PIX_FMT_YUV420P10LE, AV_PIX_FMT_YUVA420P}) {
        const Size size{514, 256};
        const Picture picture = noise(size, 1);
        const auto planes = planes_of(picture, format);
        const double scale = format == AV_PIX_FMT_YUV420P10LE ? 4 : 1;
        const int by = format == AV_PIX_FMT_YUV444P ? 1 : 2;
        double worst_luma = 0.0, worst_chroma = 0.0;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x)
                worst_luma = std::max(worst_luma, std::abs(exact_mean(picture, x, y, 1, scale).y -
                                                           planes[0][std::size_t(y) * size.width + x]));
        for (int y = 0; y < size.height / by; ++y)
            for (int x = 0; x < size.width / by; ++x) {
                const Exact e = exact_mean(picture, by * x, by * y, by, scale);
                const std::size_t i = std::size_t(y) * (size.width / by) + x;
                worst_chroma = std::max({worst_chroma, std::abs(e.cb - planes[1][i]), std::abs(e.cr - planes[2][i])});
            }
        // rounding alone has an error of 0.5; the 16 bits of the coefficients add the rest
        EXPECT_LT(worst_luma, 0.504) << int(format);    // measured 0.5012, of 10 bits 0.5014
        EXPECT_LT(worst_chroma, 0.504) << int(format);  // measured 0.5012
    }
}

TEST(Samples, GreysAndPrimariesAreTheStandards) {
    const auto of = [](AVPixelFormat format, int r, int g, int b) {
        Picture picture({2, 2});
        for (std::size_t i = 0; i < 16; ++i) picture.rgba[i] = static_cast<std::uint8_t>(std::array{r, g, b, 0}[i % 4]);
        const auto planes = planes_of(picture, format);
        return std::vector<int>{planes[0][0], planes[1][0], planes[2][0]};
    };
    for (int v = 0; v < 256; ++v) {
        const std::vector<int> grey{static_cast<int>(std::lround(16 + v * 219 / 255.0)), 128, 128};
        EXPECT_EQ(of(AV_PIX_FMT_YUV420P, v, v, v), grey);
        EXPECT_EQ(of(AV_PIX_FMT_YUV444P, v, v, v), grey);
        EXPECT_EQ(of(AV_PIX_FMT_YUV420P10LE, v, v, v),
                  (std::vector<int>{static_cast<int>(std::lround(64 + v * 876 / 255.0)), 512, 512}));
    }
    // Poynton, Digital Video and HD, 75 % and 100 % colour bars
    for (const AVPixelFormat format : {AV_PIX_FMT_YUV420P, AV_PIX_FMT_YUV444P}) {
        EXPECT_EQ(of(format, 255, 0, 0), (std::vector<int>{63, 102, 240}));
        EXPECT_EQ(of(format, 0, 255, 0), (std::vector<int>{173, 42, 26}));
        EXPECT_EQ(of(format, 0, 0, 255), (std::vector<int>{32, 240, 118}));
    }
    EXPECT_EQ(of(AV_PIX_FMT_YUV420P10LE, 255, 0, 0), (std::vector<int>{250, 409, 960}));
}

TEST(Samples, ColoursAndAlphaStayWhereTheyAreKept) {
    Picture picture = noise({37, 5}, 9);
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = static_cast<std::uint8_t>(7 * i);
    const Rect area{3, 1, 36, 4};
    const auto rgb = bytes_of_area(picture, area, AV_PIX_FMT_RGB24),
               rgba = bytes_of_area(picture, area, AV_PIX_FMT_RGBA);
    for (int i = 0; i < 33 * 3; ++i) {
        const auto* pixel = picture.at(3 + i % 33, 1 + i / 33);
        EXPECT_TRUE(std::equal(pixel, pixel + 3, rgb.data() + 3 * i)) << i;
        EXPECT_TRUE(std::equal(pixel, pixel + 4, rgba.data() + 4 * i)) << i;
    }
    Picture even = noise({36, 6}, 9);
    for (std::size_t i = 3; i < even.rgba.size(); i += 4) even.rgba[i] = static_cast<std::uint8_t>(7 * i);
    const auto planes = planes_of(even, AV_PIX_FMT_YUVA420P);
    for (std::size_t i = 0; i < planes[3].size(); ++i) EXPECT_EQ(planes[3][i], even.rgba[4 * i + 3]);
    EXPECT_EQ(planes_of(even, AV_PIX_FMT_YUV420P)[1], planes[1]);  // low alpha does not darken colours
}

TEST(Samples, AnyCoverByAreasGivesTheBytesOfTheWhole) {
    const Size size{322, 178};
    const Picture picture = noise(size, 3);
    std::mt19937 random(4);
    const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (const AVPixelFormat format : all_samples) {
        const Rect all{0, 0, size.width, size.height};
        const auto whole_bytes = bytes_of_area(picture, all, format);
        for (int trial = 0; trial < 100; ++trial) {
            const int left = upto(size.width), top = upto(size.height);
            const Rect requested{left, top, left + 1 + upto(size.width - left), top + 1 + upto(size.height - top)};
            const Rect area = aligned(format, requested, size);
            ASSERT_EQ(united(area, requested), area);
            ASSERT_TRUE(requested.left - area.left < 2 && area.right - requested.right < 2 &&
                        requested.top - area.top < 2);
            const auto bytes = bytes_of_area(picture, area, format);
            const std::uint8_t *mine = bytes.data(), *plane = whole_bytes.data();
            for (int k = 0; k < av_pix_fmt_count_planes(format); ++k) {
                const auto part = plane_area(format, k, area), full = plane_area(format, k, all);
                for (int row = 0; row < part.rows; ++row, mine += part.row_bytes)
                    ASSERT_TRUE(std::equal(mine, mine + part.row_bytes,
                                           plane + (part.top + row) * full.row_bytes + part.offset));
                plane += full.rows * full.row_bytes;
            }
            ASSERT_EQ(mine, bytes.data() + bytes.size());
        }
    }
}

TEST(Samples, OfTheLargestPictureAreCounted) {
    const Rect largest{0, 0, 16384, 16384};  // more than libav takes
    EXPECT_EQ(byte_count(AV_PIX_FMT_RGBA, largest), std::size_t{1} << 30);
    EXPECT_EQ(byte_count(AV_PIX_FMT_YUV420P10LE, largest), std::size_t{3} << 28);
}

TEST(Samples, AreasAreCutToThePictureAndEvenWhereTheyMust) {
    EXPECT_EQ(aligned(AV_PIX_FMT_YUV420P, {-3, -1, 1, 1}, {8, 6}), (Rect{0, 0, 2, 2}));
    EXPECT_EQ(aligned(AV_PIX_FMT_YUVA420P, {5, 3, 99, 99}, {8, 6}), (Rect{4, 2, 8, 6}));
    EXPECT_EQ(aligned(AV_PIX_FMT_YUV444P, {5, 3, 99, 99}, {7, 5}), (Rect{5, 3, 7, 5}));
    EXPECT_EQ(aligned(AV_PIX_FMT_RGB24, {-5, 3, 2, 4}, {7, 5}), (Rect{0, 3, 2, 4}));
    EXPECT_TRUE(aligned(AV_PIX_FMT_YUV420P, {8, 0, 9, 2}, {8, 6}).empty());
}

TEST(Samples, WhatChangedKeepsItsMemory) {
    const Size size{64, 48};
    const Picture picture = noise(size, 5);
    SampledAreas frame;
    convert(picture, whole(size), AV_PIX_FMT_YUV420P, frame);
    const auto* memory = frame.bytes.data();
    convert(picture, {{3, 3, 9, 9}, {}, {70, 0, 90, 8}, {20, 10, 30, 12}}, AV_PIX_FMT_YUV420P, frame);
    EXPECT_EQ(frame.bytes.data(), memory);
    EXPECT_EQ(frame.areas, (std::vector<Rect>{{2, 2, 10, 10}, {20, 10, 30, 12}}));
    const auto first = bytes_of_area(picture, {2, 2, 10, 10}, AV_PIX_FMT_YUV420P);
    const auto second = bytes_of_area(picture, {20, 10, 30, 12}, AV_PIX_FMT_YUV420P);
    EXPECT_TRUE(std::equal(first.begin(), first.end(), memory));
    EXPECT_TRUE(std::equal(second.begin(), second.end(), memory + first.size()));
}

}  // namespace doppel::samples_test

#include "output/decoded.hpp"
#include "output/fixtures.hpp"
#include "output/sink.hpp"

#include <libdeflate.h>
#include <malloc.h>

#include <algorithm>
#include <set>

namespace doppel::gif_apng_test {

using namespace test;
using Gif = InFolder;

namespace fs = std::filesystem;

constexpr Size small{160, 90};

unsigned big_endian(const std::string& bytes, std::size_t at, int count) {
    unsigned number = 0;
    for (int i = 0; i < count; ++i) number = number << 8 | static_cast<unsigned char>(bytes[at + std::size_t(i)]);
    return number;
}

/// Calls visit(type, content) for each chunk of a PNG.
template <class Visit>
void for_each_chunk(const fs::path& path, Visit&& visit) {
    const std::string png = bytes_of(path);
    ASSERT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    for (std::size_t at = 8; at < png.size();) {
        const std::size_t length = big_endian(png, at, 4);
        ASSERT_EQ(big_endian(png, at + 8 + length, 4), libdeflate_crc32(0, &png[at + 4], length + 4))
            << png.substr(at + 4, 4);
        visit(png.substr(at + 4, 4), png.substr(at + 8, length));
        at += length + 12;
    }
}

VideoOptions gif(Ratio rate = {25, 1}, Size size = small) {
    return {
        .format = FilmFormat::gif, .size = size, .fps_numerator = rate.numerator, .fps_denominator = rate.denominator};
}

TEST_F(Gif, TimesAreRoundedWithoutAddingUp) {
    for (const Ratio rate : {Ratio{30, 1}, Ratio{50, 1}, Ratio{24, 1}, Ratio{30000, 1001}, Ratio{7, 1}, Ratio{1, 2}}) {
        const Video video = read_video(film(folder / "x.gif", gif(rate), 13));
        ASSERT_EQ(video.times.size(), 13u);
        for (std::size_t k = 0; k < 13; ++k)
            EXPECT_NEAR(video.times[k].value(), static_cast<double>(k) / rate.value(), 0.005 + 1e-9) << k;
        EXPECT_NEAR(video.times.back().value() + video.lasting.back().value(), 13 / rate.value(), 0.005 + 1e-9);
    }
}

TEST_F(Gif, UnchangedPixelsKeepTheirColours) {
    const auto path = film(fresh_folder() / "x.gif", gif({50, 1}), 20);
    Picture source, shown;
    std::set<std::uint32_t> colours;
    read_video(path, [&](const Luma& frame) {
        const Picture next = moving_scene(small, frame.frame);
        for (std::size_t i = 0; i < next.rgba.size(); i += 4) {
            const auto same = [&](const Picture& a, const Picture& b) {
                return std::equal(&a.rgba[i], &a.rgba[i] + 4, &b.rgba[i]);
            };
            ASSERT_TRUE(frame.frame == 0 || !same(source, next) || same(shown, frame.picture)) << i;
            colours.insert(std::uint32_t{frame.picture.rgba[i]} << 16 | std::uint32_t{frame.picture.rgba[i + 1]} << 8 |
                           frame.picture.rgba[i + 2]);
        }
        source = next;
        shown = frame.picture;
    });
    EXPECT_LE(colours.size(), 255u);
    EXPECT_GT(colours.size(), 200u);
}

TEST_F(Gif, FewColoursAreExactAndFramesThatRestAreFrames) {
    const auto path = fresh_folder() / "x.gif";
    Picture picture(small);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            std::ranges::copy(std::array{17 * (x % 16), 17 * (y % 14), 9, 0}, picture.at(x, y));
    const auto sink = make_video_sink(path, gif());
    for (int k = 0; k < 5; ++k) sink->take(picture, k == 0 ? whole(small) : std::vector<Rect>{});
    sink->finish();
    double worst = 1e9;
    const Video video =
        read_video(path, [&](const Luma& frame) { worst = std::min(worst, rgb_psnr(picture, frame.picture)); });
    EXPECT_EQ(video.times.size(), 5u);
    EXPECT_GT(worst, 50.0);
    const std::string bytes = bytes_of(path);
    EXPECT_TRUE(has(bytes, "NETSCAPE2.0"));
    EXPECT_EQ(bytes.substr(bytes.find("NETSCAPE2.0") + 11, 4), std::string("\x03\x01\x00\x00", 4));  // no end
    EXPECT_EQ(bytes.back(), '\x3b');
}

TEST_F(Gif, WhatChangedStandsWhereItBelongs) {
    // a square of one colour moves over another, and a line appears with it; only changed parts are stored
    const auto path = fresh_folder() / "x.gif";
    const auto scene = [](int k) {
        Picture picture(small);
        for (int y = 0; y < small.height; ++y)
            for (int x = 0; x < small.width; ++x) {
                const bool square = x >= 31 + 5 * k && x < 60 + 5 * k && y >= 17 && y < 40, line = y == 60 + k;
                std::ranges::copy(std::array{square ? 200 : 10, 90, line ? 240 : 30, 255}, picture.at(x, y));
            }
        return picture;
    };
    const auto sink = make_video_sink(path, gif());
    for (int k = 0; k < 6; ++k)
        sink->take(scene(k), k == 0 ? whole(small)
                                    : std::vector<Rect>{{26 + 5 * k, 17, 60 + 5 * k, 40}, {0, 59 + k, 160, 61 + k}});
    sink->finish();
    double worst = 1e9;
    const Video video = read_video(path, [&](const Luma& frame) {
        worst = std::min(worst, rgb_psnr(scene(static_cast<int>(frame.frame)), frame.picture));
    });
    EXPECT_EQ(video.times.size(), 6u);
    EXPECT_EQ(worst, 1e9);  // no pixel differs
}

TEST_F(Gif, TheSameFramesGiveTheSameBytes) {
    const auto first = bytes_of(film(folder / "a.gif", gif(), 10));
    for (int k = 0; k < 2; ++k) EXPECT_TRUE(bytes_of(film(folder / "b.gif", gif(), 10)) == first);
}

TEST_F(Gif, FramesThatWaitTakeNoMemory) {
    const auto sink = make_video_sink(fresh_folder() / "x.gif", gif({25, 1}, {320, 180}));
    const auto take = [&](long from, long to) {
        for (long k = from; k < to; ++k) sink->take(moving_scene({320, 180}, k % 8), whole({320, 180}));
        const auto memory = mallinfo2();
        return memory.uordblks + memory.hblkhd;
    };
    const auto before = take(0, 20);
    EXPECT_LT(take(20, 220), before + 10'000'000);  // those 200 frames have 46 MB in all
}

TEST_F(Gif, EndsInItsCommentWhereThereIsOne) {
    // GIF89a, 24 and 27: 21 FE, blocks of at most 255 bytes with their lengths, an empty block; then 3B
    fresh_folder();  // empties it
    const auto ends_as = [&](const Metadata& metadata, const std::string& end) {
        auto options = gif();
        options.metadata = metadata;
        return bytes_of(film(folder / "x.gif", options, 2)).ends_with(end);
    };
    const std::string start = "\x21\xfe", none(1, '\0');
    EXPECT_TRUE(ends_as({{"a", "bc"}}, start + '\5' + "a: bc" + none + ';'));
    EXPECT_TRUE(ends_as({{"a", std::string(253, 'b')}},
                        start + '\xff' + "a: " + std::string(252, 'b') + '\1' + 'b' + none + ';'));
    EXPECT_TRUE(ends_as({}, none + ';'));  // the end of the last frame
    EXPECT_FALSE(ends_as({}, none + none + ';'));
}

TEST(Apng, FramesTimesAndWordsAreExact) {
    const auto path = film(fresh_folder() / "x.apng",
                           {.format = FilmFormat::apng,
                            .size = {241, 137},
                            .fps_numerator = 30000,
                            .fps_denominator = 1001,
                            .metadata = {{"title", "20°"}, {"comment", "π"}, {"encoder", "doppel 1"}}},
                           6);
    std::vector<std::string> types, texts;
    std::set<std::pair<unsigned, unsigned>> delays;
    unsigned frames = 0, plays = 7;
    for_each_chunk(path, [&](const std::string& type, const std::string& content) {
        types.push_back(type);
        if (type == "acTL") frames = big_endian(content, 0, 4), plays = big_endian(content, 4, 4);
        if (type == "fcTL") delays.insert({big_endian(content, 20, 2), big_endian(content, 22, 2)});
        if (type == "tEXt" || type == "iTXt") texts.push_back(content);
    });
    EXPECT_EQ(types.front(), "IHDR");
    EXPECT_EQ(types.back(), "IEND");
    EXPECT_EQ(frames, 6u);
    EXPECT_EQ(std::ranges::count(types, "fcTL"), 6);
    EXPECT_EQ(plays, 0u);  // repeats without end
    EXPECT_EQ(delays, (std::set<std::pair<unsigned, unsigned>>{{1001, 30000}}));
    EXPECT_EQ(texts,
              (std::vector<std::string>{std::string("Title\0\0\0\0\0"
                                                    "20°",
                                                    14),
                                        std::string("Comment\0\0\0\0\0π", 14), std::string("Software\0doppel 1", 17)}));
    const Video video = read_video(path, [](const Luma& frame) {
        EXPECT_TRUE(frame.picture.rgba == moving_scene({241, 137}, frame.frame).rgba) << frame.frame;
    });
    EXPECT_EQ(video.times.size(), 6u);
    EXPECT_EQ(video.metadata.at("software"), "doppel 1");
}

}  // namespace doppel::gif_apng_test

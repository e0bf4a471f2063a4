// Tests of all formats; for mp4 only: video_test.cpp.
#include "output/decoded.hpp"
#include "output/fixtures.hpp"
#include "output/libav_encoder.hpp"
#include "output/sink.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

namespace doppel::formats_test {

using namespace test;

namespace fs = std::filesystem;

constexpr Size small{320, 180}, tiny{96, 64};
using Pixel = std::array<std::uint8_t, 4>;

/// The scene with transparent dark pixels: opacity follows the brightest colour.
Picture clear_scene(Size size, long k) {
    Picture picture = moving_scene(size, k);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        picture.rgba[i + 3] = std::max({picture.rgba[i], picture.rgba[i + 1], picture.rgba[i + 2]});
    return picture;
}

fs::path film(const fs::path& path, const VideoOptions& options, long frames) {
    return test::film(path, options, frames, clear_scene);
}

struct Kind {
    const char* name;
    FilmFormat format;
    const char* codec;
    PixelFormat pixel_format;
    bool transparent;
    const char *codec_found, *pixels_found;
    double psnr;  // dB, of the frame with the lowest value; measured
};
constexpr auto yuv420 = PixelFormat::yuv420, yuv444 = PixelFormat::yuv444, yuv420_10 = PixelFormat::yuv420_10;
constexpr std::array kinds{
    Kind{"h264", FilmFormat::mp4, "", yuv420, false, "h264", "yuv420p", 42.8},
    Kind{"h264-444", FilmFormat::mp4, "h264", yuv444, false, "h264", "yuv444p", 42.4},
    Kind{"h264-10", FilmFormat::mp4, "", yuv420_10, false, "h264", "yuv420p10le", 42.7},
    Kind{"vp9", FilmFormat::webm, "", yuv420, false, "vp9", "yuv420p", 48.7},
    Kind{"vp9-444", FilmFormat::webm, "vp9", yuv444, false, "vp9", "yuv444p", 48.7},
    Kind{"vp9-10", FilmFormat::webm, "", yuv420_10, false, "vp9", "yuv420p10le", 49.0},
    Kind{"vp9-alpha", FilmFormat::webm, "", yuv420, true, "vp9", "yuv420p", 48.7},
    Kind{"av1", FilmFormat::webm, "av1", yuv420, false, "av1", "yuv420p", 49.0},
    Kind{"av1-444", FilmFormat::webm, "av1", yuv444, false, "av1", "yuv444p", 50.4},
    Kind{"av1-10", FilmFormat::webm, "av1", yuv420_10, false, "av1", "yuv420p10le", 49.5},
    Kind{"gif", FilmFormat::gif, "", yuv420, false, "gif", "bgra", 61.3},
    Kind{"apng", FilmFormat::apng, "", yuv420, false, "apng", "rgb24", 1e9},
    Kind{"apng-alpha", FilmFormat::apng, "", yuv420, true, "apng", "rgba", 1e9},
};

VideoOptions options_of(const Kind& kind, Size size = small) {
    return {.format = kind.format,
            .codec = kind.codec,
            .size = size,
            .fps_numerator = 50,
            .pixel_format = kind.pixel_format,
            .transparent = kind.transparent,
            .metadata = {{"title", "Three thousandths of a degree"}, {"comment", "butterfly – 90.003°"}}};
}

std::string name_of(const testing::TestParamInfo<Kind>& kind) {
    std::string name = kind.param.name;
    std::ranges::replace(name, '-', '_');
    return name;
}

class Formats : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(All, Formats, testing::ValuesIn(kinds), name_of);

/// Every encoder and every container once.
class Encoders : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(All, Encoders, testing::Values(kinds[0], kinds[6], kinds[7], kinds[10], kinds[12]), name_of);

bool is_yuv(const Kind& kind) {
    return kind.format == FilmFormat::mp4 || kind.format == FilmFormat::webm;
}

TEST(Encoder, ReportsLibavsErrors) {
    auto encoding = encoding_of({.size = tiny});
    encoding.encoder_options = {{"crf", "abc"}};
    Encoder encoder(fresh_folder() / "x.mp4", encoding, never_stopped);
    expect_io_failed({"x.mp4: libx264 refuses crf = abc: Unable to parse ", "option value \"abc\": Invalid argument"},
                     [&] { encoder.send_frame(0, 1); });
    // each is reported once
    encoding.encoder_options = {{"no-such-option", "1"}};
    Encoder other(fresh_folder() / "y.mp4", encoding, never_stopped);
    expect_io_failed({"libx264 refuses no-such-option = 1: Option not found"}, [&] { other.send_frame(0, 1); });
}

/// "key words" of the error in the options; empty if there is none.
std::string refusal(const VideoOptions& options) {
    for (const auto& error : {format_error(options), rate_error(options)})
        if (error) return fmt::format("{} {}", error->key, error->words);
    return {};
}

TEST(Formats, HaveNoSizeThatLibavDoesNotTake) {
    const Size huge{16384, 16384};
    EXPECT_EQ(refusal({.size = huge}),
              "size exceeds what libav encodes as H.264, some [16000, 16000]; it is [16384, 16384]");
    EXPECT_EQ(refusal({.format = FilmFormat::webm, .size = huge}),
              "size exceeds what libav encodes as VP9, some [16000, 16000]; it is [16384, 16384]");
    for (const Size size : {Size{16254, 16254}, Size{16384, 8192}}) {
        EXPECT_EQ(refusal({.size = size}), "");
        EXPECT_NO_THROW(check_encoder({.size = size}));
    }
}

TEST_P(Encoders, StopWhileTheyFinish) {
    std::atomic<bool> stop = false;
    const auto sink = make_video_sink(fresh_folder() / "x.part", options_of(GetParam(), tiny), stop);
    for (long k = 0; k < 30; ++k) sink->take(clear_scene(tiny, k), whole(tiny));
    stop = true;
    expect_error(ExitCode::interrupted, {"interrupted"}, [&] { sink->finish(); });
}

TEST_P(Formats, HaveTheFramesTimesTagsWordsAndLooksAskedFor) {
    const Kind& kind = GetParam();
    const auto options = options_of(kind);
    double worst = 1e9, worst_alpha = 1e9;
    const auto each = [&](const Luma& frame) {
        const Picture source = clear_scene(small, frame.frame);
        worst = std::min(worst, is_yuv(kind) ? luma_psnr(source, frame) : rgb_psnr(source, frame.picture));
        if (!kind.transparent) return;
        ASSERT_EQ(frame.alpha.size(), source.rgba.size() / 4);
        double squares = 0.0;
        for (std::size_t i = 0; i < frame.alpha.size(); ++i)
            squares += std::pow(frame.alpha[i] - source.rgba[4 * i + 3], 2);
        worst_alpha =
            std::min(worst_alpha, 10 * std::log10(255.0 * 255.0 * static_cast<double>(frame.alpha.size()) / squares));
    };
    const auto path = film(fresh_folder() / ("x" + extension(kind.format) + ".part"), options, 24);
    Video video = read_video(path, each);

    EXPECT_EQ(video.size, small);
    EXPECT_EQ(video.codec, kind.codec_found);
    EXPECT_EQ(video.pixel_format, kind.pixels_found);
    if (is_yuv(kind)) expect_bt709(video);
    ASSERT_EQ(video.times.size(), 24u);
    for (long k = 0; k < 24; ++k) EXPECT_EQ(video.times[std::size_t(k)], (Ratio{k, 50})) << k;
    EXPECT_EQ(video.average_rate, (Ratio{50, 1}));

    if (kind.format == FilmFormat::gif) {
        EXPECT_EQ(video.metadata.at("comment"), "title: Three thousandths of a degree\ncomment: butterfly – 90.003°");
    } else {
        EXPECT_EQ(video.metadata.at("title"), "Three thousandths of a degree");
        // PNG: a dash is not in ASCII, and libav does not read iTXt
        EXPECT_EQ(video.metadata.count("comment"), kind.format == FilmFormat::apng ? 0u : 1u);
        EXPECT_EQ(video.metadata["comment"], kind.format == FilmFormat::apng ? "" : "butterfly – 90.003°");
    }
    // SVT-AV1 4.2 (with FFmpeg 9) uses fewer bits at the same crf than 1.4: measured 42.3 and 47.1 dB, 8 and 10 bits
    const bool is_newer_av1 = std::string_view(kind.codec) == "av1" && avcodec_version() >= AV_VERSION_INT(62, 0, 0);
    // palettegen of libavfilter 10 chooses other colours than that of 8: measured 58.9 dB
    const double allowed = is_newer_av1 ? 7.0 : kind.format == FilmFormat::gif ? 3.5 : 1.0;
    EXPECT_GT(worst, kind.psnr - allowed);
    const double alpha_floor = !kind.transparent ? 0.0 : kind.format == FilmFormat::apng ? 1e8 : 46.0;  // measured 48.2
    EXPECT_GT(worst_alpha, alpha_floor);
}

TEST_P(Encoders, OnlyWhatChangedNeedsToBeTaken) {
    const Kind& kind = GetParam();
    if (kind.format == FilmFormat::gif) return;  // the palette depends on how often a frame is added
    auto options = options_of(kind);
    const auto square = [](long k) {
        Picture picture = clear_scene(small, 0);
        for (int y = 51; y < 84; ++y)
            for (int x = 31 + 3 * static_cast<int>(k); x < 60 + 3 * static_cast<int>(k); ++x)
                std::fill_n(picture.at(x, y), 4, 200);
        return picture;
    };
    const auto folder = fresh_folder();
    using Frame = std::tuple<std::vector<double>, std::vector<std::uint8_t>, std::vector<std::uint8_t>>;
    const auto film_squares = [&](const char* name, auto changed_in) {
        const auto sink = make_video_sink(folder / name, options);
        for (long k = 0; k < 8; ++k) sink->take(square(k), changed_in(k));
        sink->finish();
        std::vector<Frame> frames;
        read_video(folder / name, [&](const Luma& f) { frames.emplace_back(f.y, f.alpha, f.picture.rgba); });
        return frames;
    };
    const auto all = film_squares("all", [](long) { return whole(small); });
    const auto areas = film_squares("areas", [](long k) {
        const int left = 31 + 3 * static_cast<int>(k);
        return k == 0 ? whole(small) : std::vector<Rect>{{left - 3, 51, left, 84}, {}, {left + 26, 51, left + 29, 84}};
    });
    EXPECT_TRUE(all == areas);
}

TEST_P(Encoders, AFullDiskIsAlwaysAnError) {
    const Kind& kind = GetParam();
    const auto folder = fresh_folder();
    const auto path = folder / ("x" + extension(kind.format) + ".part");
    const auto options = options_of(kind, tiny);
    const auto size = static_cast<long>(fs::file_size(film(path, options, 6)));
    for (const long room : {0L, size / 2, size - 1}) {
        const FullDisk full(static_cast<std::uintmax_t>(room));
        expect_io_failed({path.string(), "File too large"}, [&] { film(path, options, 6); });
    }
    // no other file remains beside the partial file, which its owner removes
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
    expect_io_failed({"none/x", "No such file"}, [&] { make_video_sink(folder / "none/x", options); });
}

TEST_P(Encoders, DestroyedUnfinishedLeavesNothingBeside) {
    const auto folder = fresh_folder();
    auto sink = make_video_sink(folder / "x.part", options_of(GetParam(), tiny));
    for (long k = 0; k < 5; ++k) sink->take(clear_scene(tiny, k), whole(tiny));
    sink.reset();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
    make_video_sink(folder / "x.part", options_of(GetParam(), tiny)).reset();  // before the first frame
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

/// The maximum of error_of(frame) in a film of a constant picture whose columns each have one colour.
double worst_of_columns(PixelFormat pixel_format, int crf, const std::function<Pixel(int x)>& color_of,
                        const std::function<double(const Luma&)>& error_of) {
    Picture picture(small);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) std::ranges::copy(color_of(x), picture.at(x, y));
    const auto path = fresh_folder() / "x.mp4";
    const auto sink = make_video_sink(path, {.size = small, .pixel_format = pixel_format, .crf = crf});
    for (int k = 0; k < 3; ++k) sink->take(picture, whole(small));
    sink->finish();
    double worst = 0;
    read_video(path, [&](const Luma& frame) { worst = std::max(worst, error_of(frame)); });
    return worst;
}

TEST(FormatsDetail, MoreBitsAndFullChromaCarryMore) {
    // red and blue lines of one pixel: chroma at half the resolution cannot resolve them
    const auto worst_chroma = [](PixelFormat pixel_format) {
        const auto stripe = [](int x) {
            return Pixel{std::uint8_t(x % 2 ? 200 : 20), 40, std::uint8_t(x % 2 ? 20 : 200), 255};
        };
        return worst_of_columns(pixel_format, 10, stripe, [&](const Luma& frame) {
            const std::size_t width = std::size_t(small.width) * frame.chroma[1].size() / frame.y.size();
            const std::size_t by = pixel_format == yuv444 ? 1 : 2;
            double worst = 0;
            for (std::size_t i = 0; i < frame.chroma[1].size(); ++i) {
                const double r = by * (i % width) % 2 ? 200 : 20, e = 0.2126 * r + 0.7152 * 40 + 0.0722 * (220 - r);
                worst = std::max(worst, std::abs(128 + 224 * (r - e) / 1.5748 / 255 - frame.chroma[1][i]));
            }
            return worst;
        });
    };
    EXPECT_LT(worst_chroma(yuv444), 6.0);   // measured
    EXPECT_GT(worst_chroma(yuv420), 30.0);  // measured

    // a ramp from 100 to 103: 8 bits have one or two steps, 10 bits have several
    const auto levels = [](PixelFormat pixel_format) {
        const auto grey = [](int x) { return std::uint8_t(100 + 4 * x / small.width); };
        const auto ramp = [&](int x) { return Pixel{grey(x), grey(x), grey(x), 255}; };
        return worst_of_columns(pixel_format, 1, ramp, [&](const Luma& frame) {
            double worst = 0;
            for (std::size_t i = 0; i < frame.y.size(); ++i)
                worst = std::max(worst, std::abs(16 + 219 * grey(int(i) % small.width) / 255.0 - frame.y[i]));
            return worst;
        });
    };
    EXPECT_LT(levels(yuv420_10), 0.26);  // measured
    EXPECT_GT(levels(yuv420), 0.3);      // measured
}

TEST(FormatsRefusals, SayWhatIsPossible) {
    const auto refused = [](const VideoOptions& options, const std::vector<std::string>& words) {
        for (const auto& word : words) EXPECT_TRUE(has(refusal(options), word));
    };
    using F = FilmFormat;
    refused({.format = F::webm, .size = {641, 360}},
            {"size must be even for VP9 in yuv420p; it is [641, 360]; [642, 360] is possible"});
    refused({.format = F::mp4, .size = {640, 361}, .pixel_format = yuv420_10}, {"in yuv420p10", "[640, 362]"});
    refused({.format = F::gif, .size = small, .fps_numerator = 60},
            {"fps must be at most 50, as a frame of a GIF takes 2 to 65535 hundredths of a second; it is 60"});
    refused({.format = F::gif, .size = small, .fps_numerator = 1, .fps_denominator = 656}, {"at least", "1/656"});
    refused({.format = F::webm, .size = small, .fps_numerator = 3001, .fps_denominator = 3},
            {"at most 1000, as WebM counts milliseconds; it is 3001/3"});
    refused({.format = F::apng, .size = small, .fps_numerator = 65536}, {"up to 65535", "it is 65536"});
    refused({.format = F::apng, .size = small, .fps_numerator = 1, .fps_denominator = 65536}, {"65535", "1/65536"});
    refused({.format = F::mp4, .size = small, .transparent = true},
            {"transparent needs a format with opacity", "this is H.264 in yuv420p"});
    refused({.format = F::webm, .codec = "av1", .size = small, .transparent = true}, {"this is AV1 in yuv420p"});
    refused({.format = F::gif, .size = small, .fps_numerator = 25, .transparent = true}, {"this is GIF"});
    refused({.format = F::webm, .size = small, .pixel_format = yuv444, .transparent = true},
            {"this is VP9 in yuv444p"});
    for (const Kind& kind : kinds) EXPECT_EQ(refusal(options_of(kind)), "") << kind.name;
    EXPECT_EQ(refusal({.format = F::mp4, .size = {641, 361}, .pixel_format = yuv444}), "");
    EXPECT_EQ(refusal({.format = F::apng, .size = small, .fps_numerator = 65535, .fps_denominator = 65534}), "");
    EXPECT_EQ(refusal({.format = F::apng, .size = {641, 361}, .fps_numerator = 131072, .fps_denominator = 2048}), "");
}

TEST(FormatsRefusals, AMissingEncoderNamesThosePresent) {
    expect_io_failed({"without libnone and libnix", "encoders of h264", "libx264"}, [] {
        find_encoder({"libnone", "libnix"}, "h264");
    });
    EXPECT_STREQ(find_encoder({"libnone", "libx264"}, "h264").name, "libx264");
}

}  // namespace doppel::formats_test

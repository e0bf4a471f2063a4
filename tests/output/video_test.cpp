#include "output/decoded.hpp"
#include "output/fixtures.hpp"
#include "output/sink.hpp"
#include "output/system_calls.hpp"

extern "C" {
#include <libavformat/avformat.h>
}

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace doppel::video_test {

using namespace test;
using Mp4 = InFolder;

namespace fs = std::filesystem;

constexpr Size small{480, 270}, tiny{192, 108};

// libav opens a file by its name after it was created
TEST(Video, FollowsNoLinkWithItsName) {
    const auto folder = fresh_folder();
    for (const auto& [format, name] : {std::pair{FilmFormat::mp4, "x.mp4"},
                                       {FilmFormat::webm, "x.webm"},
                                       {FilmFormat::gif, "x.gif"},
                                       {FilmFormat::apng, "x.apng"}}) {
        const auto place = folder / name;
        write_bytes(folder / "thesis", "years of work");
        watch_calls([&, is_done = false](const std::string& call) mutable {
            if (is_done || call != "open64" || !fs::exists(place)) return 0;
            is_done = true;
            fs::remove(place);
            fs::create_symlink("thesis", place);
            return 0;
        });
        film(place, {.format = format, .size = {64, 36}, .fps_numerator = 25}, 3);
        watch_calls({});
        EXPECT_TRUE(bytes_of(folder / "thesis") == "years of work") << name;
    }
}

TEST_F(Mp4, HasTheFramesTimesAndTagsAskedFor) {
    for (const auto& [rate, size] : {std::pair{Ratio{120, 1}, small},
                                     {{24, 1}, tiny},
                                     {{25, 1}, tiny},
                                     {{30, 1}, tiny},
                                     {{60, 1}, tiny},
                                     {{30000, 1001}, tiny}}) {
        const VideoOptions options{.size = size,
                                   .fps_numerator = static_cast<int>(rate.numerator),
                                   .fps_denominator = static_cast<int>(rate.denominator),
                                   .metadata = {{"title", "Three thousandths of a degree"}}};
        const Video video = read_video(film(folder / "x.mp4.part", options, 61));
        EXPECT_EQ(video.size, size);
        expect_tags(video);
        EXPECT_EQ(video.title, "Three thousandths of a degree");
        EXPECT_EQ(video.average_rate, rate);
        EXPECT_EQ(video.base_rate, rate);
        EXPECT_EQ(video.duration, (Ratio{61 * rate.denominator, rate.numerator}));
        ASSERT_EQ(video.times.size(), 61u);
        for (long k = 0; k < 61; ++k) {
            EXPECT_EQ(video.times[static_cast<std::size_t>(k)], (Ratio{k * rate.denominator, rate.numerator})) << k;
            EXPECT_EQ(video.lasting[static_cast<std::size_t>(k)], (Ratio{rate.denominator, rate.numerator})) << k;
        }
    }
}

TEST(Streamed, AreWholeWithoutSeeking) {
    const auto folder = fresh_folder();
    for (const auto format : {FilmFormat::mp4, FilmFormat::webm}) {
        const VideoOptions options{.format = format, .size = small, .fps_numerator = 25, .is_stream = true};
        const auto video = read_video(film(folder / ("x" + extension(format)), options, 30));
        ASSERT_EQ(video.times.size(), 30U);
        for (long k = 0; k < 30; ++k) EXPECT_EQ(video.times[static_cast<std::size_t>(k)], (Ratio{k, 25})) << k;
        EXPECT_EQ(video.average_rate, (Ratio{25, 1}));
        expect_bt709(video);
    }
}

TEST(Y4m, HasAHeaderAndTheFrames) {
    const auto folder = fresh_folder();
    for (const auto& [pixels, chroma, bytes] : {std::tuple{PixelFormat::yuv420, "C420jpeg", 1.5},
                                                {PixelFormat::yuv444, "C444", 3.0},
                                                {PixelFormat::yuv420_10, "C420p10", 3.0}}) {
        const VideoOptions options{
            .format = FilmFormat::y4m, .size = {64, 36}, .fps_numerator = 25, .pixel_format = pixels};
        const auto text = bytes_of(film(folder / "x.y4m", options, 3));
        const auto header = text.substr(0, text.find('\n') + 1);
        EXPECT_TRUE(begins(header, fmt::format("YUV4MPEG2 W64 H36 F25:1 Ip A0:0 {} ", chroma)));
        EXPECT_EQ(text.substr(header.size(), 6), "FRAME\n");
        EXPECT_EQ(text.size(), header.size() + 3 * (6 + static_cast<std::size_t>(bytes * 64 * 36)));
    }
    const VideoOptions options{.format = FilmFormat::y4m, .size = small, .fps_numerator = 25};
    read_video(film(folder / "x.y4m", options, 2), [](const Luma& frame) {
        // 49 dB is what rounding to 8 bits of limited range leaves; measured 58
        EXPECT_GT(luma_psnr(moving_scene(small, frame.frame), frame), 49);
    });
}

TEST(Rgb, IsThePixels) {
    const auto folder = fresh_folder();
    for (const bool transparent : {false, true}) {
        const VideoOptions options{
            .format = FilmFormat::rgb, .size = {64, 36}, .fps_numerator = 25, .transparent = transparent};
        const auto bytes = bytes_of(film(folder / "x.rgb", options, 3));
        const std::size_t channels = transparent ? 4 : 3;
        ASSERT_EQ(bytes.size(), 3 * 64 * 36 * channels);
        for (long k = 0; k < 3; ++k) {
            const auto picture = moving_scene({64, 36}, k);
            for (std::size_t pixel = 0; pixel < 64 * 36; ++pixel)
                for (std::size_t c = 0; c < channels; ++c)
                    ASSERT_EQ(static_cast<std::uint8_t>(
                                  bytes[(64 * 36 * static_cast<std::size_t>(k) + pixel) * channels + c]),
                              picture.rgba[4 * pixel + c]);
        }
    }
}

/// The times of the key frames, s.
std::vector<double> key_times(const fs::path& path) {
    std::vector<double> times;
    AVFormatContext* format = nullptr;
    if (avformat_open_input(&format, path.c_str(), nullptr, nullptr) < 0) throw std::runtime_error("cannot be opened");
    auto* packet = av_packet_alloc();
    while (av_read_frame(format, packet) >= 0) {
        if (packet->flags & AV_PKT_FLAG_KEY)
            times.push_back(static_cast<double>(packet->pts) * av_q2d(format->streams[0]->time_base));
        av_packet_unref(packet);
    }
    av_packet_free(&packet);
    avformat_close_input(&format);
    return times;
}

TEST_F(Mp4, CanBeEnteredEveryFiveSeconds) {
    for (const auto& [numerator, denominator] : {std::pair{10, 1}, {24000, 1001}, {1, 10}}) {
        const double fps = double(numerator) / denominator;
        const long frames = std::lround(std::max(4.0, 12 * fps));
        const auto path = film(folder / "x.mp4",
                               {.size = {64, 36}, .fps_numerator = numerator, .fps_denominator = denominator}, frames);
        const auto times = key_times(path);
        ASSERT_FALSE(times.empty());
        EXPECT_EQ(times[0], 0);
        const double maximum = std::max(5.0, 1 / fps);
        for (std::size_t k = 1; k < times.size(); ++k) EXPECT_LE(times[k] - times[k - 1], maximum + 1e-9) << fps;
        EXPECT_LE(double(frames) / fps - times.back(), maximum + 1e-9) << fps;
    }
}

// The default's crf looks as good as veryfast's; ten bits have other quantizers.
TEST_F(Mp4, HasEqualQualityWithBothPresetsAndDepths) {
    const auto noise_of = [&](const char* preset, PixelFormat pixels) {
        double sum = 0;
        const auto path = film(folder / "x.mp4", {.size = small, .pixel_format = pixels, .preset = preset}, 60);
        read_video(path, [&](const Luma& luma) { sum += luma_psnr(moving_scene(small, luma.frame), luma); });
        return sum / 60;
    };
    // dB; measured 47.8 47.9 · 45.4 46.5
    const double ours = noise_of("doppel", PixelFormat::yuv420), stock = noise_of("veryfast", PixelFormat::yuv420);
    EXPECT_GT(ours, stock - 0.1);
    EXPECT_LT(ours, stock + 6);
    EXPECT_NEAR(noise_of("doppel", PixelFormat::yuv420_10), ours, 3);
}

TEST_F(Mp4, AFullDiskIsAlwaysAnError) {
    const auto path = fresh_folder() / "x.mp4.part";
    const VideoOptions options{.size = tiny};
    const auto size = static_cast<long>(fs::file_size(film(path, options, 60)));
    // in the header, the packets, the index, and while the packets move to make space for the index at the front
    for (const long room : {0L, 10L, size / 2, size - 5000, size - 1500, size - 500, size - 1}) {
        const FullDisk full(static_cast<std::uintmax_t>(room));
        expect_io_failed({path.string(), "File too large"}, [&] { film(path, options, 60); });
    }
    const FullDisk just_enough(static_cast<std::uintmax_t>(size));
    EXPECT_NO_THROW(film(path, options, 60));
}

TEST_F(Mp4, TakeThrowsErrorsOfTheEncodersThread) {
    const auto path = fresh_folder() / "x.mp4.part";
    const auto sink = make_video_sink(path, {.size = small, .preset = "ultrafast"});
    const FullDisk full(100'000);
    expect_io_failed({path.string(), "File too large"}, [&] {
        for (unsigned k = 0; k < 1000; ++k) sink->take(noise(small, k), whole(small));
    });
    expect_io_failed({path.string(), "File too large"}, [&] { sink->finish(); });
}

TEST_F(Mp4, DestroyedUnfinishedStopsAtOnce) {
    const Size large{1920, 1080};
    const Picture a = noise(large, 1), b = moving_scene(large, 1);
    fresh_folder();  // empties it
    // CPU time, which does not advance while other processes run
    const auto now = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    const auto fed = [&](int frames) {
        auto sink = make_video_sink(folder / "x.mp4", {.size = large, .preset = "medium"});
        for (int k = 0; k < frames; ++k) sink->take(k % 2 ? a : b, whole(large));
        return sink;
    };
    constexpr int some = 6;
    const double start = now();
    fed(some)->finish();
    const double a_frame = (now() - start) / some;
    auto sink = fed(20);
    const double end = now();
    sink.reset();
    EXPECT_LT(now() - end, 2 * a_frame);  // measured 0.74 to 0.97, and 20 if the queue is encoded to its end
}

TEST_F(Mp4, NamesItsLibraries) {
    EXPECT_EQ(libav_description().find("libavcodec "), 0u);
    EXPECT_TRUE(has(libav_description(), ", libavformat "));
}

}  // namespace doppel::video_test

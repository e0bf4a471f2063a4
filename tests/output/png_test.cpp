#include "output/png.hpp"

#include "output/decoded.hpp"
#include "output/fixtures.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>

namespace doppel {
namespace png_test {

using namespace test;
using Png = InFolder;

const std::filesystem::path full_disk = "/dev/full";

/// "0.png", "1.png", … in the folder.
std::function<std::filesystem::path(long)> numbered_in(const std::filesystem::path& folder) {
    return [folder](long k) { return folder / fmt::format("{}.png", k); };
}

TEST_F(Png, KeepsAlphaWhereAskedTo) {
    Picture picture = noise({37, 21}, 3);
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = static_cast<std::uint8_t>(3 * i);
    write_png(folder / "x.png", picture, {.with_alpha = true});
    EXPECT_EQ(read_png(folder / "x.png").rgba, picture.rgba);
    write_png(folder / "x.png", picture);
    EXPECT_TRUE(read_png(folder / "x.png").is_opaque());
    const auto sink = make_png_sink(numbered_in(folder), 2, {.with_alpha = true});
    sink->take(picture, whole(picture.size));
    sink->finish();
    EXPECT_EQ(read_png(folder / "0.png").rgba, picture.rgba);
}

TEST_F(Png, WordsCanBeReadBack) {
    const Picture picture = noise({64, 48}, 3);
    const Metadata words{{"title", "Sensitivity, 90.003°"}, {"comment", "θ → π"}, {"encoder", "doppel 0.1"}};
    const auto check_words = [&](const std::filesystem::path& path) {
        // libav reads tEXt, but not iTXt
        EXPECT_EQ(read_video(path).metadata.at("software"), "doppel 0.1");
        const auto bytes = test::bytes_of(path);
        EXPECT_TRUE(has(bytes, std::string("iTXtTitle\0\0\0\0\0Sensitivity, 90.003°", 35)));
        EXPECT_TRUE(has(bytes, std::string("iTXtComment\0\0\0\0\0θ → π", 24)));
        EXPECT_EQ(read_png(path).rgba, picture.rgba);
    };
    write_png(folder / "x.png", picture, {.metadata = words});
    check_words(folder / "x.png");
    const auto sink = make_png_sink(numbered_in(folder), 2, {.metadata = words});
    for (int k = 0; k < 3; ++k) sink->take(picture, whole(picture.size));
    sink->finish();
    check_words(folder / "2.png");
}

TEST_F(Png, RoundTripsAreBitExactForSizesInAnyOrder) {
    // a thread reuses its memory for larger and smaller pictures
    fresh_folder();  // empties it
    for (const Size size : {Size{40, 30}, Size{322, 178}, Size{1, 1}, Size{300, 7}, Size{3, 5}, Size{1280, 720}}) {
        const Picture picture = noise(size, 5);
        write_png(folder / "x.png", picture);
        const Picture back = read_png(folder / "x.png");
        EXPECT_EQ(back.size, size);
        ASSERT_EQ(back.rgba, picture.rgba) << size.width;
        expect_error(ExitCode::try_again, {"/dev/full"}, [&] { write_png(full_disk, picture); });
    }
}

// A finished 1080p frame of two panels and a strip, by level of libdeflate, ms of compression and KB:
// 1: 9.2, 150 · 2: 16.4, 147 · 4: 16.5, 146 · 6: 18.5, 142. All of write_png at level 1: 12.9 ms; with stb's filters 1,
// 2 and 3 instead of none: 22 ms and 171, 171 and 192 KB.
TEST_F(Png, AFrameOfOursIsSmall) {
    write_png(folder / "x.png", moving_scene({1920, 1080}, 60));
    EXPECT_LT(std::filesystem::file_size(folder / "x.png"), 45'000);  // measured 41 383
}

TEST_F(Png, ErrorsNameThePathAndTheReason) {
    expect_error(ExitCode::bad_input, {"none.png", "no such file"}, [&] { read_png(folder / "none.png"); });
    write_bytes(folder / "garbage.png", "this is no picture");
    expect_io_failed({"garbage.png", "decoded"}, [&] { read_png(folder / "garbage.png"); });
    expect_error(ExitCode::bad_input, {"is a folder; a picture is a PNG"}, [&] { read_png(folder); });
    // neither a file that would block nor one without end
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const auto& path : {folder / "pipe", std::filesystem::path("/dev/zero")})
        expect_error(ExitCode::bad_input, {path.string(), "is not a file; a picture is a PNG"},
                     [&] { read_png(path); });
    write_png(folder / "sparse.png", Picture({8, 8}));
    std::filesystem::resize_file(folder / "sparse.png", std::uintmax_t{1} << 31);
    expect_error(ExitCode::bad_input, {"more than 1024 MB"}, [&] { read_png(folder / "sparse.png"); });
    write_png(folder / "whole.png", noise({64, 64}, 6));
    const std::string whole_file = test::bytes_of(folder / "whole.png");
    write_bytes(folder / "half.png", whole_file.substr(0, whole_file.size() / 2));
    expect_io_failed({"half.png"}, [&] { read_png(folder / "half.png"); });

    const Picture picture = noise({64, 64}, 6);
    expect_error(ExitCode::try_again, {"/dev/full", "No space left"}, [&] { write_png(full_disk, picture); });
    expect_io_failed({"none/x.png", "No such file"}, [&] { write_png(folder / "none/x.png", picture); });
}

TEST(PngSink, WritesEveryPictureUnderItsName) {
    const auto folder = fresh_folder();
    const Size size{64, 36};
    const auto sink = make_png_sink([&](long k) { return folder / fmt::format("{:06}.png", k + 7); }, 3);
    for (unsigned k = 0; k < 40; ++k) sink->take(noise(size, k), whole(size));
    sink->finish();
    for (unsigned k = 0; k < 40; ++k)
        EXPECT_EQ(read_png(folder / fmt::format("{:06}.png", k + 7)).rgba, noise(size, k).rgba) << k;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 40);
}

TEST(PngSink, ThrowsTheFirstErrorFromTakeAndFromFinish) {
    const Size size{64, 36};
    const auto sink = make_png_sink(numbered_in(fresh_folder() / "none"), 2);
    expect_io_failed({".png", "No such file"}, [&] {
        for (unsigned k = 0; k < 1000; ++k) sink->take(noise(size, k), whole(size));
    });
    expect_io_failed({".png", "No such file"}, [&] { sink->finish(); });

    const auto late = make_png_sink(numbered_in(fresh_folder() / "none"), 2);
    late->take(noise(size, 0), whole(size));
    expect_io_failed({"0.png"}, [&] { late->finish(); });
}

TEST(PngSink, StopsWhenAsked) {
    const Size size{64, 36};
    std::atomic<bool> stop = false;
    const auto sink = make_png_sink(numbered_in(fresh_folder()), 2, {}, stop);
    sink->take(noise(size, 1), whole(size));
    stop = true;
    expect_error(ExitCode::interrupted, {"interrupted"}, [&] {
        sink->take(noise(size, 2), whole(size));  // a thread may have detected it by then
        sink->finish();
    });
}

/// Four bytes, big endian.
std::string number(std::size_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
    return bytes;
}

/// A chunk of PNG.
std::string chunk_of(const std::string& type, const std::string& content) {
    const auto checked = type + content;
    return number(content.size()) + checked + number(libdeflate_crc32(0, checked.data(), checked.size()));
}

// Memory is limited to what the file can contain: stb_image allocated 2 GB for the first file and 1 GB for the second.
TEST_F(Png, RejectsLengthsBeyondTheFile) {
    const auto path = folder / "x.png";
    write_png(path, noise({8, 8}, 5));
    auto bytes = test::bytes_of(path);
    const auto refused = [&](std::size_t at, std::string_view number, std::string_view words) {
        std::string changed = bytes;
        changed.replace(at, number.size(), number);
        if (at == 16) changed.replace(8, 25, chunk_of("IHDR", changed.substr(16, 13)));
        write_bytes(path, changed);
        expect_io_failed({"x.png", "decoded", std::string(words)}, [&] { read_png(path); });
    };
    const auto data = bytes.find("IDAT") - 4;
    refused(data, {"\x7f\0\0\0", 4}, fmt::format("the chunk at byte {} is longer than the file", data));
    refused(16, {"\0\0\x40\0\0\0\x40\0", 8}, "16384x16384 pixels cannot be in");
    // 3 bytes per pixel: one pixel more than the file can contain, and exactly as many
    const auto in_a_row = [](std::size_t pixels) { return number(pixels) + number(1); };
    refused(16, in_a_row(344 * bytes.size() + 1), "pixels cannot be in");
    refused(16, in_a_row(344 * bytes.size()), "not enough pixels");
    bytes.resize(data);
    bytes += {"\x7f\0\0\0IDAT", 8};  // the file ends here
    refused(0, "", fmt::format("the chunk at byte {} is longer than the file", data));
    write_png(path, noise({8, 8}, 5));
    std::ofstream(path, std::ios::binary | std::ios::app) << "what follows the picture";
    EXPECT_EQ(read_png(path).rgba, noise({8, 8}, 5).rgba);
}

TEST_F(Png, AWrongChecksumIsAnError) {
    const auto path = folder / "x.png";
    write_png(path, noise({300, 300}, 5));
    const auto bytes = test::bytes_of(path);
    const auto data = bytes.find("IDAT") - 4, text = bytes.find("tEXt") - 4;
    for (const auto& [at, words] : {std::pair(std::size_t{8 + 8 + 9}, std::string("its chunk IHDR at byte 8 ")),
                                    {text + 12, fmt::format("its chunk tEXt at byte {} ", text)},
                                    {data + 1000, fmt::format("its chunk IDAT at byte {} ", data)},
                                    {bytes.size() - 1, fmt::format("its chunk IEND at byte {} ", bytes.size() - 12)}}) {
        auto changed = bytes;
        changed[at] ^= 1;
        write_bytes(path, changed);
        expect_io_failed({"x.png", words + "is wrong"}, [&] { read_png(path); });
    }
}

TEST_F(Png, ColorsOtherThanSrgbAreAnError) {
    const auto path = folder / "x.png";
    write_png(path, noise({8, 8}, 5));
    const auto bytes = test::bytes_of(path);
    const auto with = [&](const std::string& chunks) {
        auto changed = bytes;
        write_bytes(path, changed.insert(8 + 25, chunks));
        return path;
    };
    const auto gamma = [&](std::uint32_t value) { return chunk_of("gAMA", number(value)); };
    const auto primaries = [&](std::uint32_t red) {
        std::string content;
        for (const std::uint32_t value : {31270u, 32900u, red, 33000u, 30000u, 60000u, 15000u, 6000u})
            content += number(value);
        return chunk_of("cHRM", content);
    };
    const auto srgb = chunk_of("sRGB", std::string(1, '\0')), profile = chunk_of("iCCP", "mine"),
               coded = chunk_of("cICP", {1, 13, 0, 1}), wide = chunk_of("cICP", {9, 16, 0, 1});
    for (const auto& chunks : {gamma(45455), gamma(45455) + primaries(64000), primaries(64001), srgb, coded,
                               srgb + gamma(100000), gamma(100000) + coded, profile + coded})
        EXPECT_EQ(read_png(with(chunks)).rgba, noise({8, 8}, 5).rgba);
    for (const auto& [chunks, words] : {std::pair(gamma(100000), "x.png: has gamma 1 (gAMA 100000, sRGB has 45455)"),
                                        {gamma(0), "gAMA 0"},
                                        {primaries(68000), "has primaries of its own (cHRM)"},
                                        {gamma(45455) + primaries(68000), "(cHRM)"},
                                        {profile, "has a colour profile (iCCP); convert it to sRGB"},
                                        {wide, "has a colour space of its own (cICP)"},
                                        {wide + srgb, "(cICP)"}})
        expect_io_failed({words}, [&] { read_png(with(chunks)); });
}

TEST(PngSink, HasThreadsForWhatFitsIntoMemory) {
    EXPECT_EQ(png_threads(7, {64, 36}), 7);
    EXPECT_GE(png_threads(0, {64, 36}), 1);
    EXPECT_LE(png_threads(1024, {3840, 2160}), 12);  // 2 GiB for all of them
    EXPECT_EQ(png_threads(64, {16384, 16384}), 1);
}

TEST(PngSink, DestroyedUnfinishedStopsAtOnce) {
    const Size size{1920, 1080};
    const Picture picture = noise(size, 8);
    auto sink = make_png_sink(numbered_in(fresh_folder()), 2);
    for (int k = 0; k < 5; ++k) sink->take(picture, whole(size));
    const auto start = std::chrono::steady_clock::now();
    sink.reset();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    EXPECT_LT(taken.count(), 1.0);  // measured 0.10
}

}  // namespace png_test
}  // namespace doppel

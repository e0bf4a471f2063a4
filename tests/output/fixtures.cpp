#include "output/fixtures.hpp"

#include "output/decoded.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <random>

namespace doppel::test {

namespace fs = std::filesystem;

fs::path test_folder() {
    const auto& test = *testing::UnitTest::GetInstance()->current_test_info();
    return fs::path(DOPPEL_TEST_OUTPUT) / (std::string(test.test_suite_name()) + "." + test.name());
}

fs::path fresh_folder() {
    const auto folder = test_folder();
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

Names listing(const fs::path& folder) {
    Names names;
    if (!fs::exists(folder)) return names;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        names.insert(entry.path().lexically_relative(folder).string());
    return names;
}

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

namespace {

struct Colour {
    double r, g, b;
};

void blend(Picture& picture, int x, int y, const Colour& colour, double cover) {
    if (x < 0 || y < 0 || x >= picture.size.width || y >= picture.size.height) return;
    std::uint8_t* p = picture.at(x, y);
    const double c[] = {colour.r, colour.g, colour.b};
    for (int i = 0; i < 3; ++i) p[i] = static_cast<std::uint8_t>(std::lround(p[i] + cover * (c[i] - p[i])));
}

void disc(Picture& picture, double cx, double cy, double radius, const Colour& colour, double cover = 1.0) {
    const int reach = static_cast<int>(radius) + 2, x0 = static_cast<int>(cx), y0 = static_cast<int>(cy);
    for (int y = y0 - reach; y <= y0 + reach; ++y)
        for (int x = x0 - reach; x <= x0 + reach; ++x)
            blend(picture, x, y, colour, cover * std::clamp(radius + 0.5 - std::hypot(x - cx, y - cy), 0.0, 1.0));
}

}  // namespace

Picture moving_scene(Size size, long k) {
    Picture picture(size);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        const std::uint8_t ground[] = {17, 20, 28, 255};
        std::copy_n(ground, 4, &picture.rgba[i]);
    }
    const double unit = size.height / 12.0;
    for (int row = 1; row < 12; ++row)
        for (int x = 0; x < size.width; ++x) blend(picture, x, static_cast<int>(row * unit), {120, 125, 140}, 0.3);
    const Colour colours[] = {{255, 150, 40}, {60, 180, 255}};
    for (int side = 0; side < 2; ++side) {
        const double pivot = size.width * (0.25 + 0.5 * side);
        // the trail, oldest end first, then rods and bobs
        for (int age = 240; age >= 0; --age) {
            const double t = (static_cast<double>(k) - 0.5 * age) / 120.0, a = 1.8 * std::cos(3.0 * t);
            const double b = a + 1.5 * std::sin(5.0 * t + side);
            const double x = pivot + unit * (2.2 * std::sin(a) + 2.2 * std::sin(b));
            const double y = 5.0 * unit + unit * (2.2 * std::cos(a) + 2.2 * std::cos(b));
            disc(picture, x, y, 1.5, colours[side], 1.0 - age / 241.0);
            if (age > 0) continue;
            for (double s = 0.0; s <= 1.0; s += 0.25 / unit) {
                disc(picture, pivot + s * unit * 2.2 * std::sin(a), (5.0 + s * 2.2 * std::cos(a)) * unit, 1.0,
                     {210, 210, 210});
                disc(picture, pivot + unit * (2.2 * std::sin(a) + s * 2.2 * std::sin(b)),
                     unit * (5.0 + 2.2 * std::cos(a) + s * 2.2 * std::cos(b)), 1.0, {210, 210, 210});
            }
            disc(picture, x, y, 0.4 * unit, colours[side]);
        }
    }
    return picture;
}

std::filesystem::path film(const std::filesystem::path& path, const VideoOptions& options, long frames,
                           Picture (*scene)(Size, long)) {
    const auto sink = make_video_sink(path, options);
    for (long k = 0; k < frames; ++k) sink->take(scene(options.size, k), whole(options.size));
    sink->finish();
    return path;
}

Picture noise(Size size, unsigned seed) {
    Picture picture(size);
    std::mt19937 random(seed);
    std::ranges::generate(picture.rgba, [&] { return static_cast<std::uint8_t>(random()); });
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
    return picture;
}

FullDisk::FullDisk(std::uintmax_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);  // so that write() returns EFBIG instead
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
}

FullDisk::~FullDisk() {
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_FSIZE, &limit);
}

void expect_error(ExitCode code, const std::vector<std::string>& words, const std::function<void()>& action) {
    try {
        action();
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        for (const std::string& part : words) EXPECT_TRUE(has(error.what(), part));
    }
}

void expect_bt709(const Video& video) {
    EXPECT_EQ(video.range, "tv");
    EXPECT_EQ(video.matrix, "bt709");
    EXPECT_EQ(video.primaries, "bt709");
    EXPECT_EQ(video.transfer, "bt709");
    if (video.pixel_format != "yuv444p") {
        EXPECT_EQ(video.chroma_location, "center");
    }
}

void expect_tags(const Video& video) {
    expect_bt709(video);
    EXPECT_EQ(video.codec, "h264");
    EXPECT_EQ(video.pixel_format, "yuv420p");
    EXPECT_TRUE(video.index_at_front);
}

}  // namespace doppel::test

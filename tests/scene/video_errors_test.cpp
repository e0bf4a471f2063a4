#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel::video_errors_test {

TEST(VideoErrors, LayoutsSayWhichSystemsTheyTake) {
    const auto message = [](const std::string& preset, const std::vector<std::string>& arguments) {
        return refusal([&] { scene_of(preset, arguments); });
    };
    EXPECT_EQ(message("springs", {"video.layout=\"phase\""}),
              "--set video.layout: [video] layout \"phase\" is for chains; the sides are mechanisms");
    EXPECT_EQ(message("two-methods", {"video.layout=\"ensemble\""}),
              "--set video.layout: [video] layout \"ensemble\" needs sides that differ only in numbers of the "
              "system, not in model");
}

TEST(VideoErrors, AFormatFromTheCommandLineDropsWhatTheFileSaysForAnother) {
    const auto read = [](const std::vector<std::string>& arguments) {
        const char* text =
            "[video]\nformat = \"webm\"\ncodec = \"av1\"\npixel_format = \"yuv420p10\"\ncrf = 60\npreset = \"slow\"";
        return preset_from(text, arguments).video;
    };
    for (const char* format : {"gif", "apng", "png"}) {
        const auto set = fmt::format("video.format=\"{}\"", format);
        const auto video = read({set});
        EXPECT_EQ(name_of(video.format), format);
        EXPECT_EQ(video.codec, "");
        EXPECT_EQ(video.pixel_format, PixelFormat::yuv420);
        EXPECT_EQ(video.crf, VideoSpec{}.crf);
        EXPECT_EQ(video.preset, VideoSpec{}.preset);
        // but keys of the command line that do not fit are errors
        for (const char* key :
             {"video.crf=20", "video.preset=\"slow\"", "video.pixel_format=\"yuv444p\"", "video.codec=\"vp9\""}) {
            const auto message = refusal([&] { read({set, key}); });
            EXPECT_TRUE(message.starts_with("--set video.")) << message;
            EXPECT_TRUE(says(message, fmt::format("the format is \"{}\"", format)));
        }
    }
    EXPECT_EQ(error_of([&] { read({"video.crf=20"}); }).second, "no error");
    EXPECT_EQ(error_of([&] { read({"video.format=\"mp4\""}); }).second,
              "x.toml:5:1: [video] crf must be from 0 to 51; it is 60");
}

TEST(VideoErrors, APreviewIsAQuarterOfThePixelsUnlessTheCommandLineSaysOtherwise) {
    const auto read = [](const std::vector<std::string>& arguments) {
        const char* text = "[video]\nsize = [1366, 768]\ncrf = 12\npreset = \"slow\"\npreview = true";
        return preset_from(text, arguments).video;
    };
    const auto video = read({});
    EXPECT_EQ(video.size, (Size{682, 384}));  // even numbers
    EXPECT_EQ(video.preset, "ultrafast");
    EXPECT_EQ(video.crf, 26);
    EXPECT_EQ(read({"video.size=[320, 180]"}).size, (Size{320, 180}));
    EXPECT_EQ(read({"video.preset=\"fast\""}).preset, "fast");
    EXPECT_EQ(read({"video.crf=30"}).crf, 30);
    EXPECT_EQ(read({"video.preview=false"}).size, (Size{1366, 768}));
    EXPECT_EQ(read({"video.size=[100, 100]", "video.preview=false"}).crf, 12);
    // the resolved preset has the final size, which is not halved again
    const auto preset = preset_from("[video]\npreview = true");
    EXPECT_EQ(preset_from(resolved_toml(preset)).video.size, (Size{960, 540}));
    EXPECT_EQ(preset_from("[video]\npreview = true\nlayout = \"portrait\"").video.size, (Size{540, 960}));
    EXPECT_EQ(preset_from("[video]\npreview = true\nformat = \"png\"").video.size, (Size{960, 540}));
}

TEST(VideoErrors, GifsGetARateThatTheyCanShow) {
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\""}).fps, (Rational{30, 1}));
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\"", "video.fps=20"}).fps, (Rational{20, 1}));
    const auto rate = [](const char* duration, const char* sampled = "scene.sample_hz=120") {
        return scene_of("butterfly", {"video.format=\"gif\"", duration, sampled, "system.integrator=\"taylor\""}).fps;
    };
    EXPECT_EQ(rate("scene.duration_s=\"1201/120\""), (Rational{30, 1}));  // for any number of samples
    EXPECT_EQ(rate("scene.duration_s=30.03", "scene.sample_hz=\"24000/1001\""), (Rational{24000, 1001}));
    EXPECT_EQ(rate("scene.duration_s=10", "scene.sample_hz=5"), (Rational{5, 1}));  // all samples
    EXPECT_EQ(rate("scene.duration_s=10", "scene.sample_hz=45"), (Rational{45, 2}));
    EXPECT_EQ(rate("scene.duration_s=10", "scene.sample_hz=100"), (Rational{25, 1}));
}

// Without the check, the clock overflowed: a run of 0.01 s was said to fail at t = 12.4787 s.
TEST(VideoErrors, FractionsWhoseProductsWouldLeave64BitsAreRefused) {
    const auto message = [](std::vector<std::string> more) {
        more.emplace_back("system.integrator=\"taylor\"");
        return error_of([&] { scene_of("butterfly", more); }).second;
    };
    const std::string hz = "scene.sample_hz=\"1000000000000000003/9999999999999937\"";
    const std::string refused =
        "--set scene.sample_hz: [scene] sample_hz must be a fraction of whole numbers up to 1000000000; it is "
        "1000000000000000003/9999999999999937";
    EXPECT_EQ(message({hz, "scene.duration_s=\"9999999999999937/1000000000000000003\""}), refused);
    EXPECT_EQ(message({hz, "scene.duration_s=\"9999999999999937/1000000000000000003\"", "video.speed=[[0, 1]]"}),
              refused);
    EXPECT_EQ(message({"scene.sample_hz=\"999999937/999999929\"", "scene.duration_s=\"999999929/999999937\"",
                       "video.fps=\"999983/999979\""}),
              "no error");
    EXPECT_EQ(
        message({"scene.sample_hz=\"999999937/999999929\"", "scene.duration_s=\"999999929/999999937\"",
                 "video.fps=\"999983/999979\"", "video.speed=\"999961/999959\""}),
        "--set video.speed: [video] speed and fps must have simpler ratios to scene.sample_hz; it is 999961/999959");
    EXPECT_EQ(
        message({"video.speed=1e-9"}),
        "--set video.speed: [video] speed times sample_hz, the frames a second without fps, must be at most 1000 and a "
        "fraction of whole numbers up to 1000000; it is 3/25000000; set fps");
    EXPECT_EQ(message({"video.fps=1000", "video.speed=\"1/1000\""}),
              "--set video.speed: [video] speed makes a film of 3e+07 frames; at most 10000000 are possible");
    EXPECT_EQ(message({"video.poster_s=30.5"}),
              "--set video.poster_s: [video] poster_s must be up to 30 s; it is 30.5");
}

}  // namespace doppel::video_errors_test

#include "scene/refused_presets.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace video_errors_test {

class VideoErrors : public testing::TestWithParam<RefusedPreset> {};

TEST_P(VideoErrors, NamePlaceValueAndRemedy) {
    const std::string text = std::string("[video]\n") + GetParam().text;
    const auto [code, message] = error_of([&] { read_preset({"x", "presets/x.toml", text}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_TRUE(message.starts_with("presets/x.toml:2:")) << message;
    EXPECT_EQ(message.substr(message.find(": [") + 2), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Keys, VideoErrors, testing::ValuesIn(refused_video_keys));

TEST(VideoErrors, LayoutsSayWhichSystemsTheyTake) {
    const auto message = [](const std::string& preset, const std::vector<std::string>& arguments) {
        return error_of([&] { scene_of(preset, arguments); }).second;
    };
    EXPECT_EQ(message("springs", {"video.layout=\"phase\""}),
              "--set video.layout: [video] layout \"phase\" is of chains; the sides are mechanisms of particles");
    EXPECT_EQ(
        message("two-methods", {"video.layout=\"ensemble\""}),
        "--set video.layout: [video] layout \"ensemble\" takes sides that differ in their numbers alone, not in how "
        "they are stepped");
}

TEST(VideoErrors, AFormatFromTheCommandLineDropsWhatTheFileSaysForAnother) {
    const auto read = [](const std::vector<std::string>& arguments) {
        const char* text =
            "[video]\nformat = \"webm\"\ncodec = \"av1\"\npixel_format = \"yuv420p10\"\ncrf = 60\npreset = \"slow\"";
        return read_preset({"x", "x.toml", text}, sets(arguments)).video;
    };
    for (const char* format : {"gif", "apng", "png"}) {
        const auto set = fmt::format("video.format=\"{}\"", format);
        const auto video = read({set});
        EXPECT_EQ(name_of(video.format), format);
        EXPECT_EQ(video.codec, "");
        EXPECT_EQ(video.pixel_format, PixelFormat::yuv420);
        EXPECT_EQ(video.crf, VideoSpec{}.crf);
        EXPECT_EQ(video.preset, VideoSpec{}.preset);
        // but not what is asked for beside it
        for (const char* key :
             {"video.crf=20", "video.preset=\"slow\"", "video.pixel_format=\"yuv444p\"", "video.codec=\"vp9\""}) {
            const auto [code, message] = error_of([&] { read({set, key}); });
            EXPECT_EQ(code, ExitCode::bad_input) << key;
            EXPECT_EQ(message.rfind("--set video.", 0), 0u) << message;
            EXPECT_NE(message.find(fmt::format("the format is \"{}\"", format)), std::string::npos) << message;
        }
    }
    EXPECT_EQ(error_of([&] { read({"video.crf=20"}); }).second, "nothing was thrown");
    EXPECT_EQ(error_of([&] { read({"video.format=\"mp4\""}); }).second,
              "x.toml:5:1: [video] crf must be from 0 to 51; it is 60");
}

TEST(VideoErrors, TheUsualRatesOfFilmsComeFromSampleRatesThatTheirRemedyNames) {
    for (const auto& [fps, hz] : {std::pair("24", "120"), {"25", "125"}, {"50", "150"}, {"60", "120"}, {"60", "60"}}) {
        const auto scene =
            scene_of("butterfly", {fmt::format("video.fps={}", fps), fmt::format("scene.sample_hz={}", hz)});
        EXPECT_EQ(scene.fps.text(), fps);
        EXPECT_EQ(scene.samples % scene.frames.stride, 0);
    }
}

TEST(VideoErrors, APreviewIsAQuarterOfThePixelsUnlessTheCommandLineSaysOtherwise) {
    const auto read = [](const std::vector<std::string>& arguments) {
        const char* text = "[video]\nsize = [1366, 768]\ncrf = 12\npreset = \"slow\"\npreview = true";
        return read_preset({"x", "x.toml", text}, sets(arguments)).video;
    };
    const auto video = read({});
    EXPECT_EQ(video.size, (Size{682, 384}));  // even
    EXPECT_EQ(video.preset, "ultrafast");
    EXPECT_EQ(video.crf, 26);
    EXPECT_EQ(read({"video.size=[320, 180]"}).size, (Size{320, 180}));
    EXPECT_EQ(read({"video.preset=\"fast\""}).preset, "fast");
    EXPECT_EQ(read({"video.crf=30"}).crf, 30);
    EXPECT_EQ(read({"video.preview=false"}).size, (Size{1366, 768}));
    EXPECT_EQ(read({"video.size=[100, 100]", "video.preview=false"}).crf, 12);
    // the resolved preset has what came of it, and is not halved again
    const auto preset = read_preset({"x", "x.toml", "[video]\npreview = true"});
    EXPECT_EQ(read_preset({"x", "x.toml", resolved_toml(preset)}).video.size, (Size{960, 540}));
    EXPECT_EQ(read_preset({"x", "x.toml", "[video]\npreview = true\nlayout = \"portrait\""}).video.size,
              (Size{540, 960}));
    EXPECT_EQ(read_preset({"x", "x.toml", "[video]\npreview = true\nformat = \"png\""}).video.size, (Size{960, 540}));
}

TEST(VideoErrors, GifsGetARateThatTheyCanShow) {
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\""}).fps, (Rational{30, 1}));
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\"", "scene.duration_s=\"3/120\""}).fps, (Rational{40, 1}));
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\"", "video.fps=20"}).fps, (Rational{20, 1}));
    const auto rate = [](const char* duration, const char* sampled = "scene.sample_hz=120") {
        return scene_of("butterfly", {"video.format=\"gif\"", duration, sampled, "system.integrator=\"taylor\""}).fps;
    };
    EXPECT_EQ(rate("scene.duration_s=10.1"), (Rational{30, 1}));    // 1212 samples
    EXPECT_EQ(rate("scene.duration_s=10.05"), (Rational{20, 1}));   // 1206: not by 4 or 5
    EXPECT_EQ(rate("scene.duration_s=30.025"), (Rational{40, 1}));  // 3 · 1201: faster rather than a frame in 10 s
    EXPECT_EQ(rate("scene.duration_s=30.03", "scene.sample_hz=\"24000/1001\""), (Rational{24000, 1001}));
    EXPECT_EQ(rate("scene.duration_s=10", "scene.sample_hz=5"), (Rational{5, 1}));  // all samples
    EXPECT_EQ(rate("scene.duration_s=10", "scene.sample_hz=45"), (Rational{45, 2}));

    const auto [code, message] = error_of([&] { rate("scene.duration_s=\"1201/120\""); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_NE(message.find("[video] fps of a GIF must let the last of 1201 samples be a frame, and no rate from 10 to "
                           "50 does; scene.duration_s = \"10\" would do"),
              std::string::npos)
        << message;
    EXPECT_EQ(rate("scene.duration_s=10"), (Rational{30, 1})) << "as the message says";
}

}  // namespace video_errors_test
}  // namespace doppel

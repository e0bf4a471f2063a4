#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace video_errors_test {

struct Case {
    const char* text;     // of [video] in presets/x.toml
    const char* message;  // after the place of the key and "[video] "
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.text;
}

class VideoErrors : public testing::TestWithParam<Case> {};

TEST_P(VideoErrors, NamePlaceValueAndRemedy) {
    const std::string text = std::string("[video]\n") + GetParam().text;
    const auto [code, message] = error_of([&] { read_preset({"x", "presets/x.toml", text}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_TRUE(message.starts_with("presets/x.toml:2:")) << message;
    EXPECT_EQ(message.substr(message.find(": [") + 2), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, VideoErrors,
    testing::Values(
        Case{"layout = \"fan\"",
             R"([video] layout must be "side-by-side", "overlay", "ensemble", "phase" or "portrait"; it is "fan")"},
        Case{"members = 5", R"([video] members is of the layout "ensemble"; it is "side-by-side")"},
        Case{"members = 1\nlayout = \"ensemble\"", "[video] members must be from 2 to 1000; it is 1"},
        Case{"phase_link = 3\nlayout = \"phase\"",
             "[video] phase_link must be from 1 to 2, as there are links; it is 3"},
        Case{
            "panels = [\"distnce\"]",
            R"([video] panels may hold "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force"; "distnce" is none of them)"},
        Case{"panels = [\"distance\"]\nlayout = \"overlay\"",
             R"([video] panels must hold "pendulums" for the layout "overlay")"},
        Case{"exponent_range = [1, 1]", "[video] exponent_range must rise; it is [1, 1]"},
        Case{"size = [1280, 720]\nlayout = \"portrait\"",
             R"([video] size must be higher than wide for the layout "portrait"; it is [1280, 720])"},
        Case{"size = [301, 200]",
             "[video] size must be even, as H.264 needs it in yuv420p; it is [301, 200]; [302, 200] would do"},
        Case{"codec = \"av1\"", R"([video] codec is a choice of webm; the format is "mp4")"},
        Case{"pixel_format = \"yuv444p\"\nformat = \"gif\"",
             R"([video] pixel_format is of mp4 and webm; the format is "gif")"},
        Case{"crf = 20\nformat = \"png\"", R"([video] crf is of mp4 and webm; the format is "png")"},
        Case{"preset = \"slow\"\nformat = \"apng\"", R"([video] preset is of mp4 and webm; the format is "apng")"},
        Case{
            "transparent = true",
            R"([video] transparent takes a format with opacity: png, apng, or webm (VP9, yuv420p); the format is "mp4")"},
        Case{"poster_s = 0.001",
             "[video] poster_s must be the time of a frame, a multiple of 1/120 s up to 30 s; it is 1/1000"},
        Case{"contact_sheet = [0, 4]", "[video] contact_sheet must be two whole numbers from 1 to 32; it is [0, 4]"},
        Case{"contact_sheet = [4, 33]", "[video] contact_sheet must be two whole numbers from 1 to 32; it is [4, 33]"},
        Case{"hold_end_s = -1", "[video] hold_end_s must be ≥ 0; it is -1"},
        Case{"title_card_s = 4000", "[video] title_card_s must be from 0 (none) to 3600; it is 4000"},
        Case{"glow_px = -1", "[video] glow_px must be from 0 (none) to 100; it is -1"},
        Case{"trail_s = 1\nlayout = \"ensemble\"",
             R"([video] trail_s must be 0 for the layout "ensemble", whose members leave no trails; it is 1)"},
        Case{"glow_px = 2\nlayout = \"ensemble\"",
             R"([video] glow_px must be 0 for the layout "ensemble", whose members leave no trails; it is 2)"},
        Case{"trail_s = nan", "[video] trail_s must be finite; it is nan"},
        Case{"theme = \"drak\"",
             R"([video] theme must be "dark", "light" or "high-contrast"; it is "drak"; did you mean "dark"?)"},
        Case{"colors.backgruond = \"#000000\"", R"([video.colors] has no "backgruond"; did you mean "background"?)"},
        Case{"colors.background = 3",
             "[video.colors] background must be a colour such as \"#ff9f40\"; it is a whole number (3)"},
        Case{"widths_px.trail = 1000", "[video.widths_px] trail must be from 0 to 200 px; it is 1000"},
        Case{"fonts_px.title = 1", "[video.fonts_px] title must be from 4 to 400 px; it is 1"}));

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

TEST(VideoErrors, GifsGetARateThatTheyCanShow) {
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\""}).fps, (Rational{30, 1}));
    EXPECT_EQ(scene_of("butterfly", {"video.format=\"gif\"", "scene.duration_s=\"1/120\""}).fps, (Rational{120, 1}));
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

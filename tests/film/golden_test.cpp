#include "output/golden.hpp"

#include "film/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace doppel::golden_test {

struct Golden {
    const char* name;  // of the file
    const char* preset;
    long sample;  // none later than 3 s: after that the picture depends on the last bit
    std::vector<std::string> sets;
};

void PrintTo(const Golden& golden, std::ostream* out) {
    *out << golden.name;
}

class GoldenFrame : public testing::TestWithParam<Golden> {};

TEST_P(GoldenFrame, IsAsItWas) {
    auto arguments = GetParam().sets;
    arguments.emplace_back("video.size=[480, 270]");
    test::expect_golden(GetParam().name, frame_of(scene_of(GetParam().preset, arguments), GetParam().sample));
}

INSTANTIATE_TEST_SUITE_P(
    Presets, GoldenFrame,
    testing::Values(Golden{"butterfly-start", "butterfly", 0, {}}, Golden{"butterfly-3s", "butterfly", 360, {}},
                    Golden{"two-methods-3s", "two-methods", 360, {}},
                    Golden{"mass-ratio-2s", "mass-ratio", 240, {"video.theme=\"light\""}},
                    Golden{"calm-3s", "calm", 360, {"video.panels=[\"pendulums\", \"distance\"]"}},
                    Golden{"triple-2s", "triple", 240, {}}, Golden{"whip-1s", "whip", 120, {"video.theme=\"light\""}},
                    Golden{"springs-2s", "springs", 240, {"scene.duration_s=3"}},
                    Golden{"loop-2s", "loop", 240, {"scene.duration_s=3"}},
                    Golden{"strips-only", "calm", 360, {"video.panels=[\"distance\", \"energy\"]"}},
                    Golden{"rods-1s", "rods", 120, {}}, Golden{"damped-3s", "damped", 360, {}},
                    Golden{"kapitza-2s", "kapitza", 240, {"video.theme=\"light\""}},
                    Golden{"measured-2s", "measured", 480, {}}, Golden{"fan-3s", "fan", 360, {"video.members=40"}},
                    Golden{"one-pendulum-2s", "one-pendulum", 240, {}},
                    Golden{"phase-dance-3s", "phase-dance", 360, {}},
                    Golden{"section-3s", "butterfly", 360, {"video.layout=\"phase\"", "video.phase=\"section\""}},
                    Golden{"slow-parting-2s", "slow-parting", 480, {}},
                    Golden{"single-and-double-3s", "single-and-double", 360, {}},
                    Golden{"overlay-3s", "calm", 360, {"video.layout=\"overlay\"", "video.theme=\"high-contrast\""}}),
    [](const auto& parameter) {
        std::string name = parameter.param.name;
        std::replace(name.begin(), name.end(), '-', '_');
        return name;
    });

// Tests of the comparison itself: these changes must be detected.

Picture sample_frame() {
    static const Picture frame = frame_of(scene_of("butterfly", {"video.size=[480, 270]"}), 120);
    return frame;
}

TEST(GoldenPolicy, PassesTheSamePictureAndWhatAnotherDriverDoes) {
    EXPECT_EQ(compare_golden(sample_frame(), sample_frame()).differing, 0);
    auto picture = sample_frame();
    for (int i = 0; i < 200; ++i) picture.at((i * 37) % 480, (i * 91) % 270)[i % 3] ^= 1;  // the last bit of some
    for (int i = 0; i < 4; ++i) picture.at(100 * i + 30, 60 * i + 20)[1] ^= 32;            // and a few edge pixels
    const auto verdict = compare_golden(sample_frame(), picture);
    EXPECT_TRUE(verdict.passes) << verdict.why;
}

/// A changed sample frame: channel c of the pixel at (x, y) becomes change(frame, x, y, c).
struct Mutation {
    const char* name;
    std::function<double(const Picture&, int, int, int)> change;
    const char* words = "";  // expected in the verdict
};

/// Reduces a channel by `by` within a rectangle.
std::function<double(const Picture&, int, int, int)> less(int channel, Rect r, int by) {
    return [=](const Picture& frame, int x, int y, int c) {
        const bool inside = x >= r.left && x < r.right && y >= r.top && y < r.bottom;
        return frame.at(x, y)[c] - (c == channel && inside ? by : 0);
    };
}

TEST(GoldenPolicy, RejectsWhatIsAnotherPicture) {
    const std::vector<Mutation> mutations{
        {"a pixel to the right", [](const auto& f, int x, int y, int c) { return f.at(std::max(x - 1, 0), y)[c]; }},
        {"a pixel down", [](const auto& f, int x, int y, int c) { return f.at(x, std::max(y - 1, 0))[c]; }},
        {"another background", [](const auto& f, int x, int y, int c) { return f.at(x, y)[c] + (c < 3 ? 1 : 0); }},
        {"another gamma", [](const auto& f, int x, int y,
                             int c) { return c < 3 ? 255 * std::pow(f.at(x, y)[c] / 255.0, 1.02) : f.at(x, y)[c]; }},
        // the effect of switching multisampling on or off: edges become a mean of their neighbours
        {"other edges", [](const auto& f, int x, int y,
                           int c) { return (3 * f.at(x, y)[c] + f.at(std::min(x + 1, f.size.width - 1), y)[c]) / 4; }},
        {"a blob", less(0, {200, 100, 203, 103}, -60)},
        {"a glaring pixel", less(2, {3, 3, 4, 4}, -255)},
        {"opacity by a level", less(3, {0, 0, 480, 270}, 1), "opacity is off by -1.000/255 on average"},
        {"opacity of half a disc", less(3, {200, 100, 203, 103}, 60), "9 pixels differ by more than 3/255"},
        {"opacity of a pixel", less(3, {3, 3, 4, 4}, 255), "a pixel differs by 255/255"},
        // one level in a third of a tile's pixels, which no other rule detects
        {"opacity in a tile", less(3, {32, 32, 64, 43}, 1), "tile differs by 0.34/255"}};
    for (const auto& [name, change, words] : mutations) {
        const auto frame = sample_frame();
        auto mutated = frame;
        for (int y = 0; y < frame.size.height; ++y)
            for (int x = 0; x < frame.size.width; ++x)
                for (int c = 0; c < 4; ++c)
                    mutated.at(x, y)[c] =
                        static_cast<std::uint8_t>(std::clamp(change(frame, x, y, c), 0.0, 255.0) + 0.5);
        const auto verdict = compare_golden(frame, mutated);
        EXPECT_FALSE(verdict.passes) << name;
        EXPECT_NE(verdict.why.find(words), std::string::npos) << name << ": " << verdict.why;
    }
}

TEST(GoldenPolicy, RefusesAnotherSize) {
    const auto [code, message] = error_of([] { compare_golden(sample_frame(), Picture({470, 270})); });
    EXPECT_EQ(code, ExitCode::differs);
    EXPECT_EQ(message, "the pictures differ in size: 480×270 expected, 470×270 found");
}

TEST(GoldenPolicy, DifferencePictureShowsAllThree) {
    auto actual = sample_frame();
    actual.at(7, 9)[1] = static_cast<std::uint8_t>(actual.at(7, 9)[1] + 5);
    const auto shown = difference_picture(sample_frame(), actual);
    EXPECT_EQ(shown.size, (Size{1440, 270}));
    EXPECT_EQ(shown.at(960 + 7, 9)[1], 80);
    EXPECT_EQ(shown.at(960 + 8, 9)[1], 0);
    actual = sample_frame();
    actual.at(7, 9)[3] = static_cast<std::uint8_t>(actual.at(7, 9)[3] - 5);
    const auto grey = difference_picture(sample_frame(), actual);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(grey.at(960 + 7, 9)[c], 80);
}

}  // namespace doppel::golden_test

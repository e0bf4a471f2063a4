#include "output/golden.hpp"

#include "film/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel {
namespace golden_test {

struct Golden {
    const char* name;  // of the file
    const char* preset;
    long sample;  // none later than 3 s: what comes after depends on the last bit
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

// The policy itself: what must not pass. A golden that lets one of these through guards nothing.

Picture sample_frame() {
    static const Picture frame = frame_of(scene_of("butterfly", {"video.size=[480, 270]"}), 120);
    return frame;
}

void expect_rejected(const Picture& mutated) {
    EXPECT_FALSE(compare_golden(sample_frame(), mutated).passes);
}

/// Every channel of every pixel changed by `change`.
template <class Change>
Picture changed(Change&& change) {
    auto picture = sample_frame();
    for (std::size_t i = 0; i < picture.rgba.size(); ++i)
        if (i % 4 != 3)
            picture.rgba[i] = static_cast<std::uint8_t>(std::clamp(change(picture.rgba[i]), 0.0, 255.0) + 0.5);
    return picture;
}

TEST(GoldenPolicy, PassesTheSamePicture) {
    EXPECT_TRUE(compare_golden(sample_frame(), sample_frame()).passes);
    EXPECT_EQ(compare_golden(sample_frame(), sample_frame()).differing, 0);
}

TEST(GoldenPolicy, PassesWhatAnotherDriverDoes) {
    auto picture = sample_frame();
    for (int i = 0; i < 200; ++i) picture.at((i * 37) % 480, (i * 91) % 270)[i % 3] ^= 1;  // a last bit here and there
    for (int i = 0; i < 4; ++i) picture.at(100 * i + 30, 60 * i + 20)[1] ^= 32;            // and a few edge pixels
    const auto verdict = compare_golden(sample_frame(), picture);
    EXPECT_TRUE(verdict.passes) << verdict.why;
}

TEST(GoldenPolicy, RejectsAShiftByAPixel) {
    const auto& frame = sample_frame();
    Picture right(frame.size), down(frame.size);
    for (int y = 0; y < frame.size.height; ++y)
        for (int x = 0; x < frame.size.width; ++x) {
            std::copy_n(frame.at(std::max(x - 1, 0), y), 4, right.at(x, y));
            std::copy_n(frame.at(x, std::max(y - 1, 0)), 4, down.at(x, y));
        }
    expect_rejected(right);
    expect_rejected(down);
}

TEST(GoldenPolicy, RejectsAnotherBackground) {
    expect_rejected(changed([](double v) { return v + 1; }));
}

TEST(GoldenPolicy, RejectsAnotherGamma) {
    expect_rejected(changed([](double v) { return 255 * std::pow(v / 255, 1.02); }));
}

TEST(GoldenPolicy, RejectsABlob) {
    auto picture = sample_frame();
    for (int y = 100; y < 103; ++y)
        for (int x = 200; x < 203; ++x) picture.at(x, y)[0] = static_cast<std::uint8_t>(picture.at(x, y)[0] + 60);
    expect_rejected(picture);
}

TEST(GoldenPolicy, RejectsOneGlaringPixel) {
    auto picture = sample_frame();
    picture.at(3, 3)[2] = 255;
    expect_rejected(picture);
}

TEST(GoldenPolicy, RejectsAnotherOpacity) {
    // all of it by a level; half of a disc's; a pixel's
    const auto mutated = [](int left, int right, int top, int bottom, int by) {
        auto picture = sample_frame();
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x)
                picture.at(x, y)[3] = static_cast<std::uint8_t>(picture.at(x, y)[3] - by);
        return picture;
    };
    const auto expect_named = [](const Picture& picture, const char* words) {
        const auto verdict = compare_golden(sample_frame(), picture);
        EXPECT_FALSE(verdict.passes);
        EXPECT_NE(verdict.why.find(words), std::string::npos) << verdict.why;
    };
    expect_named(mutated(0, 480, 0, 270, 1), "opacity is -1.000/255 off on average");
    expect_named(mutated(200, 203, 100, 103, 60), "9 pixels differ by more than 3/255");
    expect_named(mutated(3, 4, 3, 4, 255), "a pixel differs by 255/255");
    // a level in a third of a tile's pixels, which none of the other rules sees
    expect_named(mutated(32, 64, 32, 43, 1), "tile differs by 0.34/255");
}

TEST(GoldenPolicy, RejectsOtherEdges) {
    // what switching multisampling on or off does: edges that are a mean of their neighbours
    const auto& frame = sample_frame();
    auto blurred = frame;
    for (int y = 0; y < frame.size.height; ++y)
        for (int x = 0; x + 1 < frame.size.width; ++x)
            for (int c = 0; c < 3; ++c)
                blurred.at(x, y)[c] = static_cast<std::uint8_t>((3 * frame.at(x, y)[c] + frame.at(x + 1, y)[c]) / 4);
    expect_rejected(blurred);
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

}  // namespace golden_test
}  // namespace doppel

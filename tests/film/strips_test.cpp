#include "film/support.hpp"
#include "film/words.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace doppel {
namespace strips_test {

/// The label of a picture that begins so.
std::optional<Label> label_of(const std::vector<Label>& labels, const std::string& start) {
    const auto found = std::ranges::find_if(labels, [&](const Label& label) { return label.text.starts_with(start); });
    return found == labels.end() ? std::nullopt : std::optional(*found);
}

TEST(Strips, TheLastTimeStandsBelowItsTick) {
    for (const char* size : {"[1920, 1080]", "[480, 270]", "[720, 406]"}) {
        const auto scene = scene_of("butterfly", {fmt::format("video.size={}", size)});
        const auto layout = make_layout(scene);
        const auto labels = labels_of(scene, 0);
        const auto last = label_of(labels, "30 s");
        ASSERT_TRUE(last) << size;
        const float half = text_width("30", last->size) / 2, unit = text_width(" s", last->size);
        EXPECT_NEAR(last->anchor.x - unit - half, layout.strips[0].time.at(30), 3 * layout.text + 2) << size;
        EXPECT_TRUE(label_of(labels, "20")) << size << ": the label beside it has room";
    }
}

TEST(Strips, WordsAboveAreClearOfTheirAxis) {
    for (const char* size : {"[1920, 1080]", "[720, 406]", "[480, 270]"})
        for (const char* film : {"slow-parting", "two-methods", "raindrop"}) {
            const auto scene = scene_of(film, {fmt::format("video.size={}", size), "scene.duration_s=3"});
            const auto layout = make_layout(scene);
            const auto labels = labels_of(scene, 60);
            for (const auto& strip : layout.strips)
                for (const auto& label : labels)
                    if (label.anchor.y <= strip.area.top && label.anchor.y > strip.caption.top &&
                        label.anchor.x < strip.area.left) {
                        EXPECT_LE(box_of(label).bottom, strip.area.top - 0.6f * px(layout.style.font.axis))
                            << film << size << label.text;
                    }
        }
}

TEST(Strips, WhenTheyPartedIsSaidInUprightFilmsToo) {
    const auto scene = scene_of("pendulum-portrait", {"scene.duration_s=15"});
    EXPECT_TRUE(label_of(labels_of(scene, 14 * 120), "parted at 10.1 s"));
}

TEST(Strips, TheHorizonIsSaidWhereNoLineCrossesTheWords) {
    const auto words = [](const char* size, long sample) {
        const auto scene = scene_of("horizon", {fmt::format("video.size={}", size)});
        const auto layout = make_layout(scene);
        const auto found = label_of(labels_of(scene, sample), "predictability limit 3");
        return found ? std::optional(layout.strips[0].area.holds(box_of(*found))) : std::nullopt;
    };
    EXPECT_EQ(words("[1920, 1080]", 120), true);             // beside its line
    EXPECT_EQ(words("[480, 270]", 120), false);              // no room there: above
    EXPECT_EQ(words("[480, 270]", 34 * 120), std::nullopt);  // until they part, which is said there
    // a box clears the grid beneath
    const auto scene = scene_of("horizon", {"video.size=[960, 540]"});
    const auto label = *label_of(labels_of(scene, 0), "predictability limit 3");
    const auto picture = frame_of(scene, 0);
    const int y = static_cast<int>(label.anchor.y) - static_cast<int>(0.3f * label.size);
    for (int x = static_cast<int>(label.anchor.x) - 2; x < static_cast<int>(label.anchor.x); ++x)
        for (int up = -3; up < 3; ++up)
            EXPECT_EQ(std::vector<int>(picture.at(x, y + up), picture.at(x, y + up) + 3),
                      (std::vector<int>{0x0b, 0x0e, 0x13}))
                << x << ' ' << up;
}

TEST(Strips, AxesHaveTrueMinusSigns) {
    EXPECT_EQ(axis_number(-180), "−180");
    EXPECT_EQ(axis_number(0.5), "0.5");
    for (const auto& label : labels_of(scene_of("phase-dance", {"scene.duration_s=1"}), 60))
        EXPECT_EQ(label.text.starts_with('-'), false) << label.text;
}

TEST(Strips, OfATransparentFilmLetThePageThrough) {
    const auto scene =
        scene_of("butterfly", {"video.transparent=true", "video.format=\"png\"", "video.size=[480, 270]"});
    const auto layout = make_layout(scene);
    EXPECT_LT(layout.style.theme.grid.a, 0.5f);
    EXPECT_LT(layout.style.theme.panel.a, 0.2f);
    const auto own = make_layout(
        scene_of("butterfly", {"video.transparent=true", "video.format=\"png\"", "video.colors.grid=\"#ff0000\""}));
    EXPECT_EQ(own.style.theme.grid.a, 1);
}

}  // namespace strips_test
}  // namespace doppel

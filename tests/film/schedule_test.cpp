#include "film/film.hpp"
#include "film/run.hpp"
#include "film/support.hpp"
#include "output/fixtures.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace doppel {
namespace schedule_test {

namespace fs = std::filesystem;
const std::atomic<bool> never = false;

Scene held() {
    return scene_of("butterfly", {"video.size=[320, 180]", "scene.duration_s=0.25", "video.format=\"png\"",
                                  "video.hold_start_s=0.05", "video.hold_end_s=0.1", "video.title_card_s=0.2",
                                  "video.end_card_s=0.15"});
}

RunResult render(const Scene& scene, const fs::path& out, long first = 0, long last = -1) {
    return run(scene, {.out = out, .first = first, .last = last}, never, [](const Progress&) {});
}

TEST(Schedule, CountsCardsAndHoldsBesideTheMotion) {
    const auto schedule = schedule_of(held());
    EXPECT_EQ(schedule.title, 24);
    EXPECT_EQ(schedule.hold_start, 6);
    EXPECT_EQ(schedule.motion, 31);
    EXPECT_EQ(schedule.hold_end, 12);
    EXPECT_EQ(schedule.end, 18);
    EXPECT_EQ(schedule.frames(), 91);
    EXPECT_EQ(schedule_of(scene_of("butterfly")).frames(), 3601);
}

TEST(Schedule, CardsFadeOverHalfASecondAndNeverJump) {
    for (const bool fades_in : {false, true}) {
        for (const long count : {1L, 7L, 240L}) {
            double last = fades_in ? 0 : 1;
            for (long k = 0; k < count; ++k) {
                const double now = card_opacity(k, count, 120, fades_in);
                EXPECT_TRUE(fades_in ? now >= last : now <= last) << k;
                // a fade of 60 frames is steepest in its middle: 1.5/61 a frame
                if (count == 240) {
                    EXPECT_LE(std::abs(now - last), 1.5 / 61 + 1e-12) << k;
                }
                last = now;
            }
            EXPECT_GT(card_opacity(fades_in ? count - 1 : 0, count, 120, fades_in), 0.3);
        }
    }
    EXPECT_EQ(card_opacity(0, 240, 120, false), 1);
    EXPECT_EQ(card_opacity(239, 240, 120, true), 1);
}

TEST(Schedule, FramesComeInItsOrderAndRangesGiveTheSameOnes) {
    const auto whole = test::fresh_folder(), parts = whole / "parts";
    const auto scene = held();
    EXPECT_EQ(render(scene, whole).frames, 91);
    const auto frame = [&](long k) { return read_png(whole / fmt::format("butterfly/frames/{:06}.png", k)).rgba; };
    const auto first = frame_of(scene, 0).rgba, last = frame_of(scene, 30).rgba;
    EXPECT_NE(frame(0), first) << "a card hides it";
    for (const long k : {24L, 29L, 30L}) EXPECT_EQ(frame(k), first) << k;
    EXPECT_EQ(frame(35), frame_of(scene, 5).rgba);
    for (const long k : {60L, 61L, 72L}) EXPECT_EQ(frame(k), last) << k;
    EXPECT_NE(frame(90), last);

    // ranges of samples, drawn alone, are the same files; the cards belong to the first and the last sample
    std::set<std::string> seen;
    for (const auto& [from, to] : {std::pair{0L, 4L}, {4L, 30L}, {30L, 31L}}) {
        render(scene, parts, from, to);
        for (const auto& entry : fs::directory_iterator(parts / "butterfly/frames")) {
            const auto name = entry.path().filename();
            EXPECT_EQ(test::bytes_of(entry.path()), test::bytes_of(whole / "butterfly/frames" / name)) << name;
            EXPECT_TRUE(seen.insert(name).second) << name << " belongs to two ranges";
        }
    }
    EXPECT_EQ(seen.size(), 91u);
}

TEST(Schedule, PosterAndContactSheetAreFramesOfTheFilm) {
    const auto out = test::fresh_folder();
    const auto scene = scene_of("butterfly", {"video.size=[320, 180]", "scene.duration_s=0.5", "video.poster_s=0.25",
                                              "video.contact_sheet=[3, 2]"});
    render(scene, out);
    EXPECT_EQ(read_png(out / "butterfly/butterfly.poster.png").rgba, frame_of(scene, 30).rgba);
    const auto sheet = read_png(out / "butterfly/butterfly.contact.png");
    EXPECT_EQ(sheet.size, (Size{3 * 320 + 4 * 8, 2 * 180 + 3 * 8}));
    // small pictures are taken as they are: the last of them is the last frame
    const auto last = frame_of(scene, 60);
    for (int y = 0; y < 180; ++y)
        for (int x = 0; x < 320; ++x)
            ASSERT_TRUE(std::equal(last.at(x, y), last.at(x, y) + 4, sheet.at(x + 2 * 328 + 8, y + 188 + 8)))
                << x << ' ' << y;
}

}  // namespace schedule_test
}  // namespace doppel

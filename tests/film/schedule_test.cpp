#include "film/film.hpp"
#include "film/runs.hpp"
#include "film/words.hpp"
#include "output/png.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace doppel::schedule_test {

Scene held() {
    return small_scene({"video.format=\"png\"", "video.hold_start_s=0.05", "video.hold_end_s=0.1",
                        "video.title_card_s=0.2", "video.end_card_s=0.15"},
                       "0.25");
}

TEST(Schedule, CountsCardsAndHoldsBesideTheMotion) {
    const auto schedule = schedule_of(held());
    const auto [title, hold_start, motion, hold_end, end] = schedule;
    EXPECT_EQ((std::array{title, hold_start, motion, hold_end, end}), (std::array{24L, 6L, 31L, 12L, 18L}));
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
                // a fade of 60 frames changes fastest in its middle: 1.5/61 per frame
                if (count == 240) {
                    EXPECT_LE(std::abs(now - last), 1.5 / 61 + 1e-12) << k;
                }
                last = now;
            }
            EXPECT_EQ(card_opacity(fades_in ? count - 1 : 0, count, 120, fades_in), 1);
        }
    }
    EXPECT_EQ(card_opacity(0, 240, 120, false), 1);
    EXPECT_EQ(card_opacity(239, 240, 120, true), 1);
}

TEST(Schedule, FramesComeInItsOrderAndRangesGiveTheSameOnes) {
    const auto whole = test::fresh_folder(), parts = whole / "parts";
    const auto scene = held();
    EXPECT_EQ(render(scene, {.out = whole}).frames, 91);
    const auto frame = [&](long k) { return read_png(whole / fmt::format("butterfly/frames/{:06}.png", k)).rgba; };
    const auto first = frame_of(scene, 0).rgba, last = frame_of(scene, 30).rgba;
    EXPECT_NE(frame(0), first) << "a card hides it";
    for (const long k : {24L, 29L, 30L}) EXPECT_EQ(frame(k), first) << k;
    // the renderer redraws only what changes; no pixel may depend on that
    for (const long sample : {1, 5, 15, 29}) EXPECT_EQ(frame(30 + sample), frame_of(scene, sample).rgba) << sample;
    for (const long k : {60L, 61L, 72L}) EXPECT_EQ(frame(k), last) << k;
    EXPECT_NE(frame(90), last);

    // ranges of samples give the same files; the cards belong to the first and the last sample
    std::set<std::string> seen;
    for (const auto& [from, to] : {std::pair{0L, 4L}, {4L, 30L}, {30L, 31L}}) {
        render(scene, {.out = parts, .first = from, .last = to});
        for (const auto& name : files_in(parts / "butterfly/frames")) {
            EXPECT_EQ(test::bytes_of(parts / "butterfly/frames" / name),
                      test::bytes_of(whole / "butterfly/frames" / name))
                << name;
            EXPECT_TRUE(seen.insert(name).second) << name << " belongs to two ranges";
        }
    }
    EXPECT_EQ(seen.size(), 91u);
}

TEST(Schedule, ThePosterIsAFrameOfTheFilm) {
    const auto out = test::fresh_folder();
    const auto scene = small_scene({"video.poster_s=0.25"});
    render(scene, {.out = out});
    EXPECT_EQ(read_png(out / "butterfly/butterfly.poster.png").rgba, frame_of(scene, 30).rgba);
}

TEST(Schedule, TheContactSheetHasPendulumsAndTimeAndOneTitle) {
    const auto out = test::fresh_folder();
    const auto scene = small_scene({"video.trail_s=0", "b.angle_deg=[-90, -90]", "video.contact_sheet=[3, 2]"});
    render(scene, {.out = out});
    const auto sheet = read_png(out / "butterfly/butterfly.contact.png");
    const auto tile = tile_scene(scene);
    EXPECT_EQ(tile.preset.video.size, (Size{320, 180}));
    const int title = sheet.size.height - 2 * tile.preset.video.size.height - 3 * 8;
    EXPECT_EQ(sheet.size.width, 3 * 320 + 4 * 8);
    EXPECT_GT(title, 30);
    EXPECT_LT(title, 100);
    // the only text of a tile is its time
    const auto composer = composed(tile, 60);
    const auto list = tile_of(tile, *composer, 0.5);
    EXPECT_EQ(words_of({composer->backdrop(), list}), std::vector<std::string>{"0.50 s"});
    // the last tile is the end of the motion
    Renderer renderer(tile.preset.video.size, composer->backdrop());
    const auto last = renderer.draw(list);
    const int left = 2 * 328 + 8, top = title + tile.preset.video.size.height + 2 * 8;
    for (int y = 0; y < last.size.height; ++y)
        for (int x = 0; x < last.size.width; ++x)
            ASSERT_TRUE(std::equal(last.at(x, y), last.at(x, y) + 4, sheet.at(left + x, top + y))) << x << ' ' << y;
    // both pendulums fill their halves: a circle covers most of a tile's width
    const auto layout = make_layout(tile, bounds_of(scene));
    EXPECT_GT(4 * layout.reach, 0.85f * 320);
    // no frame is shown twice: three fill one row
    render(scene, {.out = out, .last = 3});
    EXPECT_EQ(read_png(out / "butterfly/butterfly.contact.png").size.height, sheet.size.height - last.size.height - 8);
}

TEST(Schedule, CardsHaveAStillOfTheOutcome) {
    const auto scene = scene_of("pendulum-portrait", {"scene.duration_s=1", "video.trail_s=0"});
    const auto composer = composed(scene, 120);
    const auto theme = make_layout(scene).style.theme;
    for (const auto& card : {composer->end_card(1), composer->title_card(1)})
        for (const auto& color : theme.sides) {
            const auto is_disc = [&](const Capsule& one) { return one.from == one.to && one.color == color; };
            EXPECT_EQ(items_in<Capsule>(card, is_disc).size(), 1u);
        }
    for (const auto& label : items_in<Label>(composer->end_card(1))) {
        EXPECT_GT(label.anchor.y - label.size, 110) << label.text;
        EXPECT_LT(label.anchor.y, 1920 - 260) << label.text;
    }
    // the whole end card fades
    for (const auto& item : composer->end_card(0.25))
        std::visit([](const auto& shape) { EXPECT_LE(shape.color.a, 0.25f); }, item);
}

}  // namespace doppel::schedule_test

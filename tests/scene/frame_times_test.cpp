#include "scene/resolved.hpp"
#include "scene/scene.hpp"
#include "scene/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace doppel {
namespace frame_times_test {

const std::string slow_at_the_parting = "video.speed=[[0, 1], [6.8, 0.25], [8.4, 1]]";

TEST(FrameTimes, AtOneSpeedAreEverySoManySamples) {
    const auto frames = scene_of("butterfly", {"video.fps=60"}).frames;
    EXPECT_EQ(frames.ticks_per_sample, 1);
    EXPECT_EQ(frames.count(), 1801);
    EXPECT_EQ(frames.tick(3), 6);
    EXPECT_EQ(frames.first_from(7), 4);
    EXPECT_EQ(frames.first_from(3601), 1801);
    EXPECT_EQ(frames.next_moment(7), 8);
}

TEST(FrameTimes, OfAChangingSpeedTakeTheTimeThatItsIntegralSays) {
    const auto video = scene_of("butterfly", {slow_at_the_parting}).preset.video;
    // seconds of film a second of motion: 1; in 0.5 s from 1 to 4, 2.5 on average; 4; 0.5 s back; 1
    EXPECT_NEAR(film_time(video, 6.3), 6.3, 1e-12);
    EXPECT_NEAR(film_time(video, 6.8), 6.3 + 0.5 * 2.5, 1e-12);
    EXPECT_NEAR(film_time(video, 7.9), 6.3 + 0.5 * 2.5 + 1.1 * 4, 1e-12);
    EXPECT_NEAR(film_time(video, 8.4), 6.3 + 0.5 * 2.5 + 1.1 * 4 + 0.5 * 2.5, 1e-12);
    EXPECT_NEAR(film_time(video, 30), 6.3 + 0.5 * 2.5 + 1.1 * 4 + 0.5 * 2.5 + 21.6, 1e-12);
    // between them by 3u² − 2u³: its slope is the pace
    for (const double u : {0.1, 0.5, 0.8}) {
        const double t = 6.3 + 0.5 * u, h = 1e-5, pace = (film_time(video, t + h) - film_time(video, t - h)) / (2 * h);
        EXPECT_NEAR(pace, 1 + 3 * (3 * u * u - 2 * u * u * u), 1e-8) << u;
    }
    EXPECT_EQ(speed_at(video, 6.5), (Rational{1, 1}));
    EXPECT_EQ(speed_at(video, 6.6), (Rational{1, 4}));
    EXPECT_EQ(speed_at(video, 8.2), (Rational{1, 1}));
}

TEST(FrameTimes, OfAChangingSpeedAreAsDenseAsTheSlowestPartNeeds) {
    for (const char* fps : {"24", "25", "50", "60", "120"}) {
        const auto scene = scene_of("butterfly", {slow_at_the_parting, fmt::format("video.fps={}", fps)});
        const auto& frames = scene.frames;
        EXPECT_EQ(250 % frames.ticks_per_sample, 0);  // steps stay whole
        EXPECT_EQ(frames.tick(0), 0);
        EXPECT_EQ(frames.tick(frames.count() - 1), 3600 * frames.ticks_per_sample);
        const double rate = scene.fps.value();
        for (long k = 0; k + 1 < frames.count(); ++k) {
            // off by no more than half a tick: of a frame's way at the slowest, 1/64
            const double off = film_time(scene.preset.video, scene.time_of_tick(frames.tick(k))) * rate - double(k);
            ASSERT_LE(std::abs(off), 1.0 / 64) << fps << " frame " << k;  // measured 1/78 at 24, 1/125 at 120
        }
    }
}

TEST(FrameTimes, EachSpeedsFramesFallOnTicksWhereStepsAllowIt) {
    // 25 ticks a sample would be fine enough, 37.5 from frame to frame
    const auto frames =
        scene_of("butterfly", {"video.speed=[[0, 1], [5, 0.3]]", "video.fps=24", "video.speed_ease_s=0"}).frames;
    EXPECT_EQ(frames.ticks_per_sample, 50);
    for (long k = 0; k < 120; ++k) ASSERT_EQ(frames.tick(k + 1) - frames.tick(k), 250) << k;
    for (long k = 120; k + 2 < frames.count(); ++k) ASSERT_EQ(frames.tick(k + 1) - frames.tick(k), 75) << k;
}

TEST(FrameTimes, SamplesAreTheSameWhateverTheSpeed) {
    const auto even = scene_of("butterfly"), changing = scene_of("butterfly", {slow_at_the_parting});
    ASSERT_GT(changing.frames.ticks_per_sample, 1);
    PairRun one(even), other(changing);
    const std::atomic<bool> never = false;
    for (long n = 0; n <= 360; ++n) {
        const auto x = one.next(never), y = other.next(never);
        ASSERT_EQ(x.sample, y.sample);
        ASSERT_EQ(even.time(n), changing.time_of_tick(y.tick));
        ASSERT_EQ(x.distance, y.distance) << n;
        ASSERT_EQ(x.a.bobs.back().x, y.a.bobs.back().x) << n;
    }
}

TEST(FrameTimes, ResolvedPresetsKeepTheSpeeds) {
    const auto scene = scene_of("butterfly", {slow_at_the_parting, "video.speed_ease_s=0.2"});
    const auto again = make_scene(read_preset({"x", "x.toml", resolved_toml(scene.preset), "x.toml"}));
    EXPECT_EQ(again.preset.video.speed.changes, scene.preset.video.speed.changes);
    EXPECT_EQ(again.frames.ticks, scene.frames.ticks);
}

TEST(FrameTimes, StepsThatAreTooCoarseForASpeedAreRefused) {
    const auto [code, message] = error_of([] {
        scene_of("butterfly", {slow_at_the_parting, "system.step_s=\"1/240\""});
    });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_EQ(message,
              "butterfly: [video] speed 0.25 at 120 frames/s needs moments that are 0.00026 s apart; a step is 0.00417 "
              "s: step_s = \"1/3840\", or fps up to 7, would do");
    // what it says is so, and no more than is needed
    const auto fan = [](const char* more) { scene_of("fan", {"video.speed=[[0, 1], [5, 0.25]]", more}); };
    EXPECT_EQ(error_of([&] { fan("video.fps=120"); }).second,
              "fan: [video] speed 0.25 at 120 frames/s needs moments that are 0.00026 s apart; a step is 0.000417 s: "
              "step_s = \"1/4800\", or fps up to 75, would do");
    EXPECT_NO_THROW(fan("system.step_s=\"1/4800\""));
    EXPECT_NO_THROW(fan("video.fps=75"));
    EXPECT_THROW(fan("video.fps=76"), Error);
}

}  // namespace frame_times_test
}  // namespace doppel

#include "scene/resolved.hpp"
#include "scene/scene.hpp"
#include "scene/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace doppel::frame_times_test {

const std::string slow_at_the_parting = "video.speed=[[0, 1], [6.8, 0.25], [8.4, 1]]";

/// In samples.
double position(const Moment& moment) {
    return static_cast<double>(moment.sample) + moment.share;
}

TEST(FrameTimes, AtOneSpeedAreEverySoManySamples) {
    const auto frames = scene_of("butterfly", {"video.fps=60"}).frames;
    EXPECT_EQ(frames.count, 1801);
    EXPECT_EQ(frames.at(3), Moment{6});
    EXPECT_EQ(frames.at(1800), Moment{3600});
    EXPECT_EQ(frames.first_from({7}), 4);
    EXPECT_EQ(frames.first_from({8}), 4);
    EXPECT_EQ(frames.first_from({8, 0.5}), 5);
    EXPECT_EQ(frames.first_from({3601}), 1801);
}

TEST(FrameTimes, OfAnyRateAreAtTheirTimesToTheLastDigit) {
    struct Case {
        const char *fps, *exact;
        long frames;  // duration · fps, rounded up, and the end
    };
    for (const auto& [fps, exact, frames] : {Case{"23.976", "24000/1001", 721},
                                             {"\"24000/1001\"", "24000/1001", 721},
                                             {"23.98", "24000/1001", 721},
                                             {"24", "24", 721},
                                             {"25", "25", 751},
                                             {"29.97", "30000/1001", 901},
                                             {"47.952", "48000/1001", 1440},
                                             {"50", "50", 1501},
                                             {"59.94", "60000/1001", 1800},
                                             {"119.88", "120000/1001", 3598},
                                             {"144", "144", 4321},
                                             {"7.3", "73/10", 220},
                                             {"29.96", "749/25", 900}}) {
        const auto scene = scene_of("butterfly", {fmt::format("video.fps={}", fps)});
        EXPECT_EQ(scene.fps.text(), exact);
        EXPECT_EQ(scene.frames.count, frames) << fps;
        EXPECT_EQ(scene.frames.at(frames - 1), Moment{3600}) << "the end is a frame";
        for (long n = 0; n + 1 < frames; ++n) {
            const double time =
                static_cast<double>(n * scene.fps.denominator) / static_cast<double>(scene.fps.numerator);
            ASSERT_NEAR(scene.time(scene.frames.at(n)), time, 1e-14 * 30) << fps << " frame " << n;
            ASSERT_EQ(scene.frames.first_from(scene.frames.at(n)), n);
        }
    }
}

TEST(FrameTimes, OfAChangingSpeedTakeTheTimeThatItsIntegralSays) {
    const auto video = scene_of("butterfly", {slow_at_the_parting}).preset.video;
    // seconds of film per second of motion: 1; in 0.5 s from 1 to 4, 2.5 on average; 4; 0.5 s back to 1
    EXPECT_NEAR(film_time(video, 6.3), 6.3, 1e-12);
    EXPECT_NEAR(film_time(video, 6.8), 6.3 + 0.5 * 2.5, 1e-12);
    EXPECT_NEAR(film_time(video, 7.9), 6.3 + 0.5 * 2.5 + 1.1 * 4, 1e-12);
    EXPECT_NEAR(film_time(video, 8.4), 6.3 + 0.5 * 2.5 + 1.1 * 4 + 0.5 * 2.5, 1e-12);
    EXPECT_NEAR(film_time(video, 30), 6.3 + 0.5 * 2.5 + 1.1 * 4 + 0.5 * 2.5 + 21.6, 1e-12);
    // between them by 3u² − 2u³: its slope is the rate of the film's time
    for (const double u : {0.1, 0.5, 0.8}) {
        const double t = 6.3 + 0.5 * u, h = 1e-5, pace = (film_time(video, t + h) - film_time(video, t - h)) / (2 * h);
        EXPECT_NEAR(pace, 1 + 3 * (3 * u * u - 2 * u * u * u), 1e-8) << u;
    }
    EXPECT_EQ(speed_at(video, 6.5), (Rational{1, 1}));
    EXPECT_EQ(speed_at(video, 6.6), (Rational{1, 4}));
    EXPECT_EQ(speed_at(video, 8.2), (Rational{1, 1}));
}

TEST(FrameTimes, OfAChangingSpeedAreAtTheTimesThatTheyAreShownAt) {
    for (const char* fps : {"23.976", "24", "25", "50", "60", "120"}) {
        const auto scene = scene_of("butterfly", {slow_at_the_parting, fmt::format("video.fps={}", fps)});
        const auto& frames = scene.frames;
        EXPECT_EQ(frames.at(0), Moment{0});
        EXPECT_EQ(frames.at(frames.count - 1), Moment{3600});
        for (long k = 0; k + 1 < frames.count; ++k) {
            const double off = film_time(scene.preset.video, scene.time(frames.at(k))) * scene.fps.value() - double(k);
            ASSERT_LE(std::abs(off), 1e-5) << fps << " frame " << k;
        }
    }
}

TEST(FrameTimes, OfEachSpeedFallOnSamplesWhereTheyCan) {
    const auto frames =
        scene_of("butterfly", {"video.speed=[[0, 1], [5, 0.3]]", "video.fps=24", "video.speed_ease_s=0"}).frames;
    for (long k = 0; k <= 120; ++k) ASSERT_EQ(frames.at(k), Moment{5 * k}) << k;
    for (long k = 0; 120 + 2 * k + 1 < frames.count; ++k) ASSERT_EQ(frames.at(120 + 2 * k), Moment{600 + 3 * k}) << k;
    EXPECT_NEAR(position(frames.at(121)), 601.5, 1e-9);
}

// Frames between samples must not change the samples: neither their steps nor the rounding of their times.
TEST(FrameTimes, SamplesDoNotDependOnFramesBetweenThem) {
    struct Case {
        const char* preset;
        std::vector<std::string> more;
    };
    for (const auto& [preset, more] : {Case{"butterfly", {}},
                                       {"butterfly", {"system.integrator=\"rk4\"", "system.model=\"constraints\""}},
                                       {"butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1e-10"}},
                                       {"butterfly", {"system.integrator=\"dopri5\"", "system.tolerance=1e-10"}},
                                       {"butterfly", {"system.integrator=\"dop853\"", "system.model=\"constraints\""}},
                                       {"whip", {}},
                                       {"loop", {}},
                                       {"damped", {"system.integrator=\"dop853\"", "system.tolerance=1e-10"}},
                                       {"raindrop", {"system.integrator=\"taylor\"", "system.tolerance=1e-25"}}}) {
        const auto scene = scene_of(preset, more);
        PairRun one(scene), other(scene);
        for (long n = 0; n <= 240; ++n) {
            const auto x = one.next(never), y = other.next(never);
            ASSERT_EQ(x.sample, y.sample);
            ASSERT_EQ(x.distance, y.distance) << preset << ' ' << n;
            ASSERT_EQ(x.a.energy, y.a.energy) << preset << ' ' << n;
            for (std::size_t i = 0; i < x.b.bobs.size(); ++i) {
                ASSERT_EQ(x.b.bobs[i].x, y.b.bobs[i].x) << preset << ' ' << n;
                ASSERT_EQ(x.b.bobs[i].theta, y.b.bobs[i].theta) << preset << ' ' << n;
            }
            for (const double share : {0.1, 0.2, 0.21, 0.6 + 0.3 * std::sin(n), 0.95})
                if (share < 0.2 || n % 3 == 0) other.advance_to({n, share}, never);
        }
    }
}

// Compares with a run that has its samples there: between samples the motion is as accurate as the method.
TEST(FrameTimes, BetweenSamplesIsTheMotion) {
    struct Case {
        const char* preset;
        std::vector<std::string> more;
        double maximum;  // m
    };
    for (const auto& [preset, more, maximum] :
         {Case{"butterfly", {}, 0},  // with the same steps
          {"butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1e-12"}, 1e-11},
          {"butterfly",
           {"system.integrator=\"dop853\"", "system.model=\"constraints\"", "system.tolerance=1e-12"},
           1e-9},
          {"whip", {}, 1e-9},
          {"measured", {}, 1e-4}}) {  // round-off of a time may decide which samples of a track surround it
        const auto scene = scene_of(preset, more);
        auto fine = more;
        fine.push_back(fmt::format("scene.sample_hz={}", 5 * scene.preset.sample_hz.numerator));
        const auto finer = scene_of(preset, fine);
        PairRun run(scene), truth(finer);
        auto expected = truth.next(never);
        for (long n = 0; n < 120; ++n) {
            run.next(never);
            for (const double fifth : {1, 2, 3, 4}) {
                const auto state = run.advance_to({n, fifth / 5}, never);
                expected = truth.next(never);
                ASSERT_NEAR(scene.time(state.moment()), finer.time(expected.sample), 1e-14);
                for (std::size_t i = 0; i < state.a.bobs.size(); ++i) {
                    ASSERT_NEAR(state.a.bobs[i].x, expected.a.bobs[i].x, maximum) << preset << ' ' << n << ' ' << fifth;
                    ASSERT_NEAR(state.a.bobs[i].theta, expected.a.bobs[i].theta, 100 * maximum) << preset << ' ' << n;
                }
            }
            expected = truth.next(never);
        }
    }
}

TEST(FrameTimes, OfFixedStepsAreAtTheNearestStep) {
    const auto scene = scene_of("butterfly", {"system.step_s=\"1/1200\""});
    PairRun run(scene);
    run.next(never);
    const auto x_at = [&](double share) { return run.advance_to({0, share}, never).a.bobs[1].y; };
    const double third = x_at(0.26);
    EXPECT_EQ(x_at(0.3), third);
    EXPECT_EQ(x_at(0.34), third);
    EXPECT_NE(x_at(0.36), third);
}

TEST(FrameTimes, ResolvedPresetsKeepTheSpeeds) {
    const auto scene = scene_of("butterfly", {slow_at_the_parting, "video.speed_ease_s=0.2", "video.fps=29.97"});
    const auto again = scene_from(resolved_toml(scene.preset));
    EXPECT_EQ(again.preset.video.speed.changes, scene.preset.video.speed.changes);
    EXPECT_EQ(again.frames.changing, scene.frames.changing);
    EXPECT_EQ(again.fps, (Rational{30000, 1001}));
}

TEST(FrameTimes, StepsThatAreTooCoarseForASpeedAreRefused) {
    EXPECT_EQ(
        refusal([] {
            scene_of("butterfly", {slow_at_the_parting, "system.step_s=\"1/240\""});
        }),
        "butterfly: [video] frames are 0.00208 s of the motion apart and not all at steps, which are 0.00417 s long "
        "on side a: they must be at most 0.00026 s, by a smaller step_s or accuracy");
    // the remedy in the message works
    EXPECT_NO_THROW(scene_of("butterfly", {slow_at_the_parting, "system.step_s=\"1/3840\""}));
    EXPECT_NO_THROW(scene_of("butterfly", {"system.step_s=\"1/240\""})) << "each frame is a step";
    EXPECT_THROW(scene_of("butterfly", {"system.step_s=\"1/120\"", "video.fps=50"}), Error);
    EXPECT_NO_THROW(scene_of("butterfly", {"system.integrator=\"taylor\"", "video.speed=\"1/1000\"", "video.fps=60"}));
}

}  // namespace doppel::frame_times_test

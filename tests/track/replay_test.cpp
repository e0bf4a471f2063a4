// A measured motion replayed from its track, compared with the true motion.
#include "track/replay.hpp"

#include "errors.hpp"
#include "track/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::replay_test {

using namespace test;

std::shared_ptr<const Track> track_of(const std::string& text) {
    return std::make_shared<const Track>(tracks_of_texts({"swing.csv"}, {text}));
}

/// The largest errors of angles, rates, positions and energy at 240 times per second.
struct Errors {
    double angle = 0, rate = 0, place = 0, energy = 0;
};
Errors errors_of(const std::string& text, std::array<double, 2> offset = {}) {
    const auto spec = swinging_rods({1, 240});
    const auto truth = make_motion(spec), shown = make_replay(spec, replay_from(track_of(text), std::nullopt, offset));
    Errors worst;
    const auto keep = [](double& maximum, double error) { maximum = std::max(maximum, std::abs(error)); };
    for (int k = 0; k <= 480; ++k) {
        if (k > 0) truth->advance(never_stop), shown->advance(never_stop);
        const auto a = truth->observe(), b = shown->observe();
        for (std::size_t i = 0; i < 2; ++i) {
            keep(worst.angle, a.bobs[i].theta - b.bobs[i].theta);
            keep(worst.rate, a.bobs[i].omega - b.bobs[i].omega);
            keep(worst.place, std::hypot(a.bobs[i].x - b.bobs[i].x, a.bobs[i].y - b.bobs[i].y));
        }
        keep(worst.energy, a.energy - b.energy);
    }
    return worst;
}

TEST(Replay, ShowsTheMotionThatWasMeasured) {
    auto worst = errors_of(csv_of_motion(swinging_rods(), 1002));
    EXPECT_LT(worst.angle, 1e-5);   // measured 2e-6
    EXPECT_LT(worst.rate, 2e-3);    // measured 6e-4 of 16 rad/s
    EXPECT_LT(worst.place, 2e-6);   // measured 4e-7
    EXPECT_LT(worst.energy, 2e-3);  // measured 5e-4 of 4 J
    worst = errors_of(csv_of_motion(swinging_rods(), 1002, 1e-4));
    EXPECT_LT(worst.angle, 7e-4);  // smoothing reduces the noise: measured 4.9e-4, the largest of 962
    EXPECT_LT(worst.rate, 0.15);   // measured 0.097; differences of samples would give 0.2
}

TEST(Replay, GoesThroughCoarseSamples) {
    auto spec = swinging_rods({1, 30});
    spec.chain->angle = {Quad(0.6), Quad(-0.5)};
    spec.chain->rate = {0, 0};
    spec.physical->chain = *spec.chain;
    for (const double noise : {0.0, 1e-3}) {
        const auto shown = make_replay(spec, replay_from(track_of(csv_of_motion(spec, 102, noise)), std::nullopt, {}));
        const auto truth = make_motion(spec);
        double worst = 0;
        for (int k = 0; k < 60; ++k) {
            if (k > 0) truth->advance(never_stop), shown->advance(never_stop);
            for (std::size_t i = 0; i < 2; ++i)
                worst = std::max(worst, std::abs(truth->observe().bobs[i].theta - shown->observe().bobs[i].theta));
        }
        EXPECT_LT(worst, 1e-6 + 4 * noise);
    }
}

TEST(Replay, SubtractsEncoderOffsets) {
    const auto text = csv_of_motion(swinging_rods(), 1002, 0, 0.05);
    EXPECT_GT(errors_of(text).angle, 0.049);
    EXPECT_LT(errors_of(text, {0.05, -0.05}).angle, 1e-5);
}

TEST(Replay, LeavesOutliersOut) {
    auto text = csv_of_motion(swinging_rods(), 1002);
    const auto row = text.find("\n0.4,");
    ASSERT_NE(row, std::string::npos);
    text.replace(row + 1, text.find('\n', row + 1) - row - 1, "0.4,9,9");
    EXPECT_LT(errors_of(text).angle, 1e-5);
}

TEST(Replay, BeginsWhereItIsToldAndEndsWithItsPiece) {
    auto text = csv_of_motion(swinging_rods(), 1202);
    const auto from = text.find("\n1,") + 1, to = text.find("\n1.5,") + 1;
    text.erase(from, to - from);  // 0 … 0.998 s and 1.5 … 2.402 s
    const auto track = track_of(text);
    EXPECT_NEAR(replay_from(track, std::nullopt, {}).length(), 0.998, 1e-12);
    const auto later = replay_from(track, 1.6, {});
    EXPECT_EQ(later.piece, 1u);
    EXPECT_NEAR(later.length(), 0.802, 1e-12);
    const auto shown = make_replay(swinging_rods({2, 5}), later);
    const auto truth = make_motion(swinging_rods({8, 5}));
    truth->advance(never_stop);
    EXPECT_NEAR(shown->observe().bobs[1].theta, truth->observe().bobs[1].theta, 1e-5);
    shown->advance(never_stop), shown->advance(never_stop);
    EXPECT_EQ(thrown_by([&] { shown->advance(never_stop); }),
              Thrown(ExitCode::method_failed, "the track ends 0.802 s after its start"));
    for (const double gap : {1.2, -1.0, 3.0})
        EXPECT_EQ(thrown_by([&] { replay_from(track, gap, {}); }).second,
                  fmt::format("is {} s, without a sample there: the track goes from 0 to 2.402 s, in 2 pieces", gap));
}

}  // namespace doppel::replay_test

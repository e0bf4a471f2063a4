#include "scene/manifest.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace {

TEST(Presets, AreAllReadable) {
    for (const auto& source : builtin_presets()) {
        const auto scene = make_scene(read_preset(source));
        EXPECT_NE(scene.preset.title, source.name) << "a preset says what it shows";
    }
}

TEST(Presets, HaveTheStartsTheyPromise) {
    const auto start = [](const char* name) {
        const auto scene = scene_of(name);
        return std::pair{scene.preset.a, scene.preset.b};
    };
    const auto [a, b] = start("butterfly");
    EXPECT_EQ(a.angle_deg, (std::vector<Quad>{90, 90}));
    EXPECT_EQ(b.angle_deg, (std::vector<Quad>{parse_quad("90.003"), 90}));
    EXPECT_EQ(start("calm").second.angle_deg, (std::vector<Quad>{parse_quad("20.003"), 0}));
    EXPECT_EQ(start("mass-ratio").second.mass_kg, (std::vector<Quad>{parse_quad("1.01"), 1}));
    const auto methods = scene_of("two-methods");
    EXPECT_EQ(methods.a.motion.model, Model::angles);
    EXPECT_EQ(methods.b.motion.model, Model::constraints);
    EXPECT_EQ(methods.samples, 4500);
}

TEST(Presets, ComeBackFromTheirResolvedForm) {
    for (const auto& source : builtin_presets()) {
        const auto preset = read_preset(source, sets({"video.fps=60", "video.side_colors=[\"#102030\", \"#a0b0c0\"]"}));
        const auto text = resolved_toml(preset);
        EXPECT_EQ(resolved_toml(read_preset({source.name, "resolved", text})), text);
    }
}

TEST(Clock, SampleNIsStep250N) {
    const auto scene = scene_of("butterfly", {"scene.duration_s=2"});
    EXPECT_EQ(scene.a.motion.steps_per_sample, 250);
    PairRun pair(scene);
    MotionSpec spec;
    spec.chain = scene.b.motion.chain;
    auto by_hand = make_motion(spec);
    const std::atomic<bool> never = false;
    for (long n = 0; n <= 240; ++n) {
        const auto moment = pair.next(never);
        ASSERT_EQ(moment.sample, n);
        ASSERT_EQ(moment.b.bobs[1].x, by_hand->observe().bobs[1].x) << n;  // to the last bit
        by_hand->advance(never);
    }
}

TEST(Clock, TimeIsWhatTheSampleNumberSays) {
    const auto scene = scene_of("butterfly", {"scene.sample_hz=30", "system.step_s=\"1/30000\""});
    EXPECT_EQ(scene.time(7), 7.0 / 30);
    EXPECT_EQ(scene.samples, 900);
    EXPECT_EQ(scene.fps.text(), "30");
}

TEST(Clock, SpeedAndFramesFallOnSamples) {
    const auto slow = scene_of("butterfly", {"video.speed=0.25", "scene.sample_hz=240"});
    EXPECT_EQ(slow.fps.text(), "60");
    EXPECT_EQ(slow.samples_per_frame, 1);
    EXPECT_EQ(scene_of("butterfly", {"video.fps=60"}).samples_per_frame, 2);
}

TEST(AutoModel, IsTheSmallestThatServes) {
    const auto scene = scene_of("butterfly");
    EXPECT_EQ(scene.a.motion.model, Model::angles);
    EXPECT_NE(scene.a.why.find("closed form"), std::string::npos);
}

TEST(Sides, MayDifferInModelMethodAndStep) {
    const auto scene = scene_of(
        "butterfly", {"a.model=\"constraints\"", "b.integrator=\"rk4\"", "b.step_s=\"1/1200\"", "scene.duration_s=1"});
    EXPECT_EQ(scene.a.motion.model, Model::constraints);
    EXPECT_EQ(scene.b.method.name, "rk4");
    EXPECT_EQ(scene.b.motion.steps_per_sample, 10);
    PairRun pair(scene);
    const std::atomic<bool> never = false;
    Moment last;
    for (int n = 0; n <= 120; ++n) last = pair.next(never);
    EXPECT_LT(std::abs(last.b.bobs[0].x - last.a.bobs[0].x), 0.01);  // they are the same pendulum; measured 7e-4
}

TEST(PairRun, TellsWhereAMethodBrokeDown) {
    const auto scene = scene_of(
        "butterfly", {"b.step_s=\"1/3\"", "scene.sample_hz=3", "scene.duration_s=3000", "b.model=\"constraints\""});
    const auto [code, message] = error_of([&] {
        PairRun pair(scene);
        const std::atomic<bool> never = false;
        for (long n = 0; n <= scene.samples; ++n) pair.next(never);
    });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_NE(message.find("butterfly: side b broke down by t = "), std::string::npos) << message;
    EXPECT_NE(message.find("constraints, explicit Euler, 1/3 s"), std::string::npos) << message;
}

TEST(Layout, AxesStayFiniteForAnyPreset) {
    for (const char* key :
         {"system.length_m=[1e200, 1]", "system.mass_kg=[1e300, 1]", "system.mass_kg=[1e-300, 1]",
          "system.gravity_m_per_s2=1e300", "system.length_m=[1e-200, 1e-200]", "b.mass_kg=[1e300, 1]"}) {
        const Axis axis = make_layout(scene_of("butterfly", {key})).distance->value;
        EXPECT_GT(axis.low, 0) << key;
        EXPECT_GE(axis.high / axis.low, 9.99) << key;
        EXPECT_LE(axis.high / axis.low, 1.01e60) << key;
        EXPECT_LT(axis.high, 1e61) << key;
    }
}

TEST(PairRun, StopsInTheMiddleOfALongSample) {
    const auto scene = scene_of("butterfly", {"scene.sample_hz=1", "system.step_s=1e-9", "video.fps=1"});
    PairRun pair(scene);
    std::atomic<bool> stop = false;
    pair.next(stop);
    stop = true;
    EXPECT_EQ(error_of([&] { pair.next(stop); }).first, ExitCode::interrupted);
}

}  // namespace
}  // namespace doppel

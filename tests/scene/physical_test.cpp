// Links with mass, friction and drives, from a preset to a scene.
#include "scene/captions.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

namespace doppel::physical_test {

PhysicalPendulum<Quad> physical_of_a(const std::string& system) {
    return physical_of(preset_from("[system]\n" + system).a);
}

TEST(Physical, AnEvenRodHasItsMiddleAndATwelfth) {
    const auto p = physical_of_a("mass_kg = 0\nrod_mass_kg = [1.2, 3]\nlength_m = [1, 2]");
    EXPECT_EQ(p.chain.mass[0], parse_quad("1.2"));
    EXPECT_EQ(p.center[1], 1);
    EXPECT_EQ(p.inertia[1], 1);  // m l²/12
}

TEST(Physical, ABobOnARodIsOneBodyAboutTheirCentre) {
    const auto p = physical_of_a("mass_kg = [2, 1]\nrod_mass_kg = [1, 0]\nlength_m = [3, 1]");
    EXPECT_EQ(p.chain.mass[0], 3);
    EXPECT_EQ(p.center[0], Quad(5) / 2);
    // about the joint: m l² + M l²/3
    EXPECT_EQ(p.inertia[0] + 3 * p.center[0] * p.center[0], 2 * 9 + 3);
    EXPECT_EQ(p.center[1], 1);
    EXPECT_EQ(p.inertia[1], 0);
}

TEST(Physical, WithoutPropertiesIsThePointMassChain) {
    EXPECT_FALSE(scene_of("butterfly").a.motion.physical);
    const auto none = scene_from("[system]\nrod_mass_kg = 0\njoint_viscous_N_m_s = [0, 0]");
    EXPECT_FALSE(none.a.motion.physical);
    EXPECT_EQ(resolved_toml(none.preset).find("viscous"), std::string::npos);
    const auto one = scene_from("[a]\njoint_viscous_N_m_s = [0, 0.1]");
    EXPECT_TRUE(one.a.motion.physical);
    EXPECT_FALSE(one.b.motion.physical);
}

TEST(Physical, CaptionsStateTheDifference) {
    const auto scene =
        scene_from("[system.pivot]\namplitude_m = 0.1\n[b]\njoint_viscous_N_m_s = 0.5\n[b.pivot]\nfrequency_hz = 3");
    const auto words = side_captions(scene);
    EXPECT_EQ(words[0].heading, "no viscous friction, pivot frequency 1 Hz");
    EXPECT_EQ(words[1].heading, "viscous friction 0.5 N m s, pivot frequency 3 Hz");
    EXPECT_EQ(scene_caption(scene_of("driven")).substr(0, 40), "two pendulums with friction and a motor ");
}

TEST(Physical, TheEnergyStripShowsEnergyWhereItIsNotKept) {
    EXPECT_EQ(scene_of("damped").preset.video.strips[1], StripKind::total_energy);
    EXPECT_EQ(scene_of("rods").preset.video.strips[1], StripKind::energy);  // links with mass conserve it
}

TEST(Physical, RefusalsSayWhatWouldBeRight) {
    const std::vector<std::pair<const char*, const char*>> refused{
        {"[system]\nmass_kg = [0, 1]", "x.toml:2:1: [system] mass_kg[0] must be > 0; it is 0"},
        {"[system]\nmass_kg = [0, 1]\nrod_mass_kg = [0, 1]",
         "x.toml:2:1: [system] mass_kg of link 1 and its rod_mass_kg are both 0; one must be > 0"},
        {"[system]\njoint_viscous_N_m_s = -1", "x.toml:2:1: [system] joint_viscous_N_m_s[0] must be ≥ 0; it is -1"},
        {"[[system.torque]]\njoint = 3\namplitude_N_m = 1",
         "x.toml:2:1: [[system.torque]] 1 joint must be 1 to 2, the number of links; it is 3"},
        {"[system.pivot]\namplitude_m = 1\nfrequency_hz = 0",
         "x.toml:3:1: [system.pivot] frequency_hz must be > 0; it is 0"},
        {"[system]\nrod_mass_kg = 1\n[video]\npanels = [\"pendulums\", \"rod-force\"]",
         "x: [video] panels: \"rod-force\" needs massless rods; links with mass, friction or a drive, and tracks, have "
         "no rod tension"},
        {"[system]\njoint_viscous_N_m_s = 1\n[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [0, 1]",
         "x.toml:3:10: [system] force cannot be combined with links with mass, friction or a drive, which need a plain "
         "chain"}};
    for (const auto& [text, message] : refused) expect_refused(text, message);
}

/// The largest angle error of a preset's run up to its horizon, against another method.
double error_at_end(const Preset& preset) {
    const auto scene = make_scene(preset);
    auto truth = scene.a.motion;
    truth.method = "taylor";
    truth.tolerance = parse_quad("1e-15");
    auto requested = scene.a.motion;
    const auto one = make_motion(requested), other = make_motion(truth);
    double worst = 0;
    const long last = scene.a.choice->horizon;
    for (long n = 0; n < last; ++n) {
        one->advance(never);
        other->advance(never);
        const auto a = one->observe(), b = other->observe();
        for (std::size_t i = 0; i < a.bobs.size(); ++i)
            worst = std::max(worst, std::abs(a.bobs[i].theta - b.bobs[i].theta));
    }
    return worst;
}

TEST(Physical, AnAccuracyIsMet) {
    // random scenes of this kind; fifty with DOPPEL_ALL_SCENES=1
    const int scenes = std::getenv("DOPPEL_ALL_SCENES") ? 50 : 6;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    const auto number = [&](double low, double high) {
        return fmt::format("{:.4f}", low + (high - low) * share(random));
    };
    for (int k = 0; k < scenes; ++k) {
        const auto pair = [&](double low, double high) {
            return fmt::format("[{}, {}]", number(low, high), number(low, high));
        };
        std::string text = fmt::format(
            "[scene]\nduration_s = 3\nsample_hz = 20\n[video]\nfps = 20\n[system]\naccuracy = 1e-{}\nangle_deg = {}\n",
            3 + k % 5, pair(-170, 170));
        if (k % 2 == 0) text += fmt::format("rod_mass_kg = {}\n", pair(0.1, 1));
        if (k % 3 == 0) text += fmt::format("drag_quadratic_N_s2_per_m2 = {}\n", pair(0, 0.1));
        text += fmt::format("joint_viscous_N_m_s = {}\n", pair(0, 0.3));
        if (k % 4 == 1)
            text +=
                fmt::format("[system.pivot]\namplitude_m = {}\nfrequency_hz = {}\n", number(0.02, 0.2), number(0.5, 5));
        const auto preset = preset_from(text);
        EXPECT_LE(error_at_end(preset), static_cast<double>(*preset.a.accuracy)) << text;
    }
}

}  // namespace doppel::physical_test

#include "scene/scene.hpp"

#include "base/machine.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace doppel::scene_test {

TEST(Presets, AreAllReadable) {
    for (const auto& source : builtin_presets()) {
        if (is_figure(source)) continue;
        const auto scene = make_scene(read_preset(source));
        EXPECT_NE(scene.preset.title, source.name) << "a preset says what it shows";
    }
}

TEST(Presets, HaveTheirDocumentedStarts) {
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

TEST(Presets, ResolvedReadsBackToTheSame) {
    for (const auto& source : builtin_presets()) {
        if (is_figure(source)) continue;
        const auto preset = read_preset(source, sets({"video.fps=60", "video.side_colors=[\"#102030\", \"#a0b0c0\"]"}));
        const auto text = resolved_toml(preset);
        const auto again = read_preset({source.name, "resolved", text});
        EXPECT_EQ(resolved_toml(again), text);
        for (const auto side : {&Preset::a, &Preset::b}) {
            EXPECT_EQ((again.*side).physical, (preset.*side).physical) << source.name;
            EXPECT_EQ((again.*side).track.sha256, (preset.*side).track.sha256) << source.name;
            EXPECT_EQ((again.*side).track.offset_deg, (preset.*side).track.offset_deg) << source.name;
        }
    }
    EXPECT_EQ(resolved_toml(read_preset(find_preset("butterfly"))).find("track"), std::string::npos);
}

TEST(Clock, SampleNIsStep250N) {
    const auto scene = scene_of("butterfly", {"scene.duration_s=2"});
    EXPECT_EQ(scene.a.motion.steps_per_sample, 250);
    PairRun pair(scene);
    MotionSpec spec;
    spec.chain = scene.b.motion.chain;
    auto by_hand = make_motion(spec);
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
    EXPECT_EQ(slow.frames.stride, (Rational{1, 1}));
    EXPECT_EQ(scene_of("butterfly", {"video.fps=60"}).frames.stride, (Rational{2, 1}));
}

TEST(AutoModel, IsTheSmallestThatSupportsTheScene) {
    const auto scene = scene_of("butterfly");
    EXPECT_EQ(scene.a.motion.model, Model::angles);
    EXPECT_TRUE(says(scene.a.why, "closed form"));
}

TEST(AutoModel, ExplainsAnotherChoice) {
    const auto why = [](const std::vector<std::string>& arguments) {
        const auto scene = scene_of("butterfly", arguments);
        return std::pair{scene.a.motion.model, scene.a.why};
    };
    EXPECT_EQ(why({"system.integrator=\"rattle\""}),
              (std::pair{Model::constraints, std::string("\"rattle\" integrates particles with constraints")}));
    EXPECT_EQ(why({"system.stabilise=\"projection\""}),
              (std::pair{Model::constraints, std::string("only constraints can be stabilised")}));
    EXPECT_EQ(scene_from("[system]\nlinks = 7").a.motion.model, Model::angles);
}

TEST(Numbers, MeanTheirDecimals) {
    const auto preset =
        preset_from("[system]\nangle_deg = [90.003, 1_0.1]\ngravity_m_per_s2 = 9.80665", {"b.mass_kg=[0.1, +1e-1]"});
    EXPECT_EQ(preset.a.angle_deg[0], Quad(90003) / 1000);
    EXPECT_EQ(preset.a.angle_deg[1], Quad(101) / 10);
    EXPECT_EQ(preset.a.gravity_m_per_s2, Quad(980665) / 100000);
    EXPECT_EQ(preset.b.mass_kg[0], Quad(1) / 10);
    EXPECT_EQ(preset.b.mass_kg[1], Quad(1) / 10);
    EXPECT_NE(preset.b.mass_kg[0], Quad(0.1));
    // degrees turn into radians with π to 34 digits
    const auto angle = make_scene(preset).a.motion.chain->angle[0];
    const auto expected = parse_quad("1.57084868667245644911862940236281");  // 90.003 π / 180
    EXPECT_LT(abs(angle - expected), parse_quad("3e-32"));                   // measured 4e-33
    EXPECT_EQ(text_of(parse_quad("90.003")), "90.003");
    EXPECT_EQ(parse_quad(text_of(Quad(1) / 3)), Quad(1) / 3);
}

TEST(Numbers, EqualInDoubleNeedQuad) {
    const std::vector<std::string> apart{"b.angle_deg=[90.00000000000000000001, 90]"};
    EXPECT_EQ(
        refusal([&] { scene_of("butterfly", apart); }),
        "butterfly: angle_deg[0] is 90 on side a and 90.00000000000000000001 on side b, the same number in double: "
        "both sides would move identically. Set precision = \"quad\"");
    auto in_quad = apart;
    in_quad.emplace_back("system.precision=\"quad\"");
    EXPECT_NO_THROW(scene_of("butterfly", in_quad));
}

/// The error of two sides with the keys `in_a` and `in_b`, which override `system`.
std::pair<ExitCode, std::string> error_of_sides(const std::string& system, const std::string& in_a,
                                                const std::string& in_b, const std::string& precision = "double") {
    const auto text = "[system]\nprecision = \"" + precision + "\"\n" + system + "\n[a]\n" + in_a + "\n[b]\n" + in_b;
    return error_of([&] { scene_from(text); });
}

TEST(Numbers, OfAnyKeyEqualInDoubleNeedQuad) {
    const std::string spring =
        "integrator = \"rk4\"\n[[system.particle]]\nname = \"u\"\n[[system.force]]\nkind = \"spring\"\n"
        "name = \"s\"\nfrom = \"u\"\nto = [0, 2]\n[[system.constraint]]\nkind = \"slot-line\"\nname = \"rail\"\n"
        "particle = \"u\"\ndirection = [1, 1]\n";
    const std::string motor = "[[system.torque]]\nname = \"t\"\namplitude_N_m = 1\n";
    const auto entry = [](const std::string& table, const std::string& name, const std::string& line) {
        return std::array{"[[a." + table + "]]\nname = \"" + name + "\"\n" + line,
                          "[[b." + table + "]]\nname = \"" + name + "\"\n" + line + "000000000000000000001"};
    };
    const auto pivot = [](const std::string& line) {
        return std::array{"[a.pivot]\namplitude_m = 0.1\n" + line,
                          "[b.pivot]\namplitude_m = 0.1\n" + line + "000000000000000000001"};
    };
    const auto key = [](const std::string& line) { return std::array{line, line + "000000000000000000001"}; };
    const struct {
        std::string system;
        std::array<std::string, 2> sides;
        std::string name;
    } all[]{{"", key("joint_viscous_N_m_s = 0.1"), "joint_viscous_N_m_s[0]"},
            {"", key("joint_coulomb_N_m = 0.1"), "joint_coulomb_N_m[0]"},
            {"", key("arm_drag_quadratic_N_m_s2 = 0.1"), "arm_drag_quadratic_N_m_s2[0]"},
            {"", key("drag_linear_N_s_per_m = 0.1"), "drag_linear_N_s_per_m[0]"},
            {"", key("rod_mass_kg = 0.1"), "rod_mass_kg[0]"},
            {"", key("center_m = 0.1"), "center_m[0]"},
            {"", key("inertia_kg_m2 = 0.1"), "inertia_kg_m2[0]"},
            {"", key("mass_kg = 0.1"), "mass_kg[0]"},
            {"", key("length_m = 0.1"), "length_m[0]"},
            {"", key("gravity_m_per_s2 = 9.8"), "gravity_m_per_s2"},
            {"", key("omega_deg_per_s = 9.8"), "omega_deg_per_s[0]"},
            {"", pivot("frequency_hz = 1.5"), "pivot frequency_hz"},
            {"", pivot("phase_deg = 1.5"), "pivot phase_deg"},
            {motor, entry("torque", "t", "amplitude_N_m = 0.1"), "torque \"t\" amplitude_N_m"},
            {motor, entry("torque", "t", "phase_deg = 0.1"), "torque \"t\" phase_deg"},
            {spring, entry("force", "s", "stiffness_N_per_m = 1.5"), "spring \"s\" stiffness_N_per_m"},
            {spring, entry("force", "s", "length_m = 0.1"), "spring \"s\" length_m"},
            {spring, entry("force", "s", "damping_N_s_per_m = 0.1"), "spring \"s\" damping_N_s_per_m"},
            {spring,
             {"[[a.constraint]]\nname = \"rail\"\ndirection = [1, 1]",
              "[[b.constraint]]\nname = \"rail\"\ndirection = [1, 1.000000000000000000001]"},
             "slot-line \"rail\" direction[1]"},
            {spring, entry("particle", "u", "mass_kg = 1.0"), "particle \"u\" mass_kg"},
            // 1 ulp of degrees is less than one of radians
            {"", {"angle_deg = [120, 90]", "angle_deg = [120.00000000000001, 90]"}, "angle_deg[0]"},
            // the length of one side equals the distance at the start
            {spring + "[[system.force]]\nkind = \"spring\"\nname = \"r\"\nfrom = \"u\"\nto = [0, 1]\n",
             {"", "[[b.force]]\nname = \"r\"\nlength_m = 1.000000000000000000001"},
             "spring \"r\" length_m"}};
    for (const auto& [system, sides, name] : all) {
        const auto [code, message] = error_of_sides(system, sides[0], sides[1]);
        EXPECT_EQ(code, ExitCode::bad_input) << name << ": " << message;
        EXPECT_TRUE(says(message, "x: " + name + (name.ends_with("r\" length_m") ? " differ" : " is ")));
        EXPECT_TRUE(says(message, "both sides would move identically. Set precision = \"quad\""));
        EXPECT_EQ(error_of_sides(system, sides[0], sides[1], "quad").first, ExitCode::done) << name;
    }
    // equal sides are accepted if the difference has no effect in quad either
    EXPECT_EQ(error_of_sides("", "[a.pivot]\namplitude_m = 0\nphase_deg = 1", "[b.pivot]\namplitude_m = 0").first,
              ExitCode::done);
}

TEST(Numbers, EqualInQuadAreRefused) {
    // 1 ulp of degrees in quad is less than one of radians
    const auto [code, message] =
        error_of_sides("", "angle_deg = [125, 90]", "angle_deg = [125.00000000000000000000000000000001, 90]", "quad");
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_TRUE(says(message, "the same number in quad: both sides would move identically"));
    const auto long_one = error_of_sides("", "", "angle_deg = [90.00000000000000000000000000000000000001, 90]", "quad");
    EXPECT_EQ(long_one.second,
              "x.toml:7:1: [b] angle_deg[0] must have at most 34 digits, the precision of quad; it has 40");
    const auto step = error_of_sides("", "step_s = 0.001", "step_s = 0.00100000000000000000001");
    EXPECT_TRUE(says(step.second, "[b] step_s is no fraction of whole numbers up to 9.2e18"));
    // trailing zeros do not count
    EXPECT_EQ(error_of_sides("", "", "angle_deg = [91.00000000000000000000000000000000000000, 90]").first,
              ExitCode::done);
}

TEST(Scene, OfAsManyLinksAsThereMayBeIsMadeAtOnce) {
    const auto preset = preset_from("[system]\nlinks = 10000\n[b]\ngravity_m_per_s2 = 9.7");
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto scene = make_scene(preset);
    EXPECT_EQ(scene.b.mass.size(), 10000u);
    EXPECT_LT(seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, 2);  // measured 0.19 s; was 31
}

TEST(ExclusiveKeys, TheCommandLineReplacesKeysOfAnotherKind) {
    // butterfly has step_s = "1/30000"
    const auto adaptive = scene_of("butterfly", {"system.integrator=\"taylor\""});
    EXPECT_FALSE(adaptive.preset.a.step_s);
    EXPECT_EQ(adaptive.a.motion.tolerance, usual_tolerance);
    const auto given = scene_of("butterfly", {"system.integrator=\"taylor\"", "system.tolerance=1e-9"});
    EXPECT_EQ(given.b.motion.tolerance, parse_quad("1e-9"));
    const auto fixed = scene_of("whip", {"system.integrator=\"rk4\""});
    EXPECT_FALSE(fixed.preset.a.tolerance);
    EXPECT_EQ(fixed.a.step, default_step);
    // the preset gives one side its own method
    const auto mixed = scene_from("[system]\nstep_s = \"1/600\"\n[b]\nintegrator = \"dop853\"");
    EXPECT_EQ(mixed.a.step, (Rational{1, 600}));
    EXPECT_EQ(mixed.b.motion.tolerance, usual_tolerance);

    const auto message = [](const std::vector<std::string>& arguments) {
        return error_of([&] { scene_of("butterfly", arguments); }).second;
    };
    EXPECT_EQ(message({"system.integrator=\"taylor\"", "system.step_s=0.001"}),
              R"(--set system.step_s: [system] step_s is for methods with a fixed step; "taylor" uses tolerance)");
    EXPECT_EQ(message({"system.tolerance=1e-9"}),
              R"(--set system.tolerance: [system] tolerance is for adaptive methods; "euler" uses step_s)");
}

TEST(Sides, MayDifferInModelMethodAndStep) {
    const auto scene = scene_of(
        "butterfly", {"a.model=\"constraints\"", "b.integrator=\"rk4\"", "b.step_s=\"1/1200\"", "scene.duration_s=1"});
    EXPECT_EQ(scene.a.motion.model, Model::constraints);
    EXPECT_EQ(scene.b.method.name, "rk4");
    EXPECT_EQ(scene.b.motion.steps_per_sample, 10);
    PairRun pair(scene);
    PairState last;
    for (int n = 0; n <= 120; ++n) last = pair.next(never);
    EXPECT_LT(std::abs(last.b.bobs[0].x - last.a.bobs[0].x), 0.001);  // measured 0.0002
}

TEST(PairRun, ReportsWhereAMethodFailed) {
    const auto scene = scene_of(
        "butterfly", {"b.step_s=\"1/3\"", "scene.sample_hz=3", "scene.duration_s=3000", "b.model=\"constraints\""});
    const auto [code, message] = error_of([&] {
        PairRun pair(scene);
        for (long n = 0; n <= scene.samples; ++n) pair.next(never);
    });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_TRUE(says(message, "butterfly: side b failed by t = "));
    EXPECT_TRUE(says(message, "constraints, explicit Euler, 1/3 s"));
}

TEST(PairRun, StopsInTheMiddleOfALongSample) {
    const auto scene = scene_of("butterfly", {"scene.sample_hz=1", "system.step_s=1e-9", "video.fps=1"});
    PairRun pair(scene);
    std::atomic<bool> stop = false;
    pair.next(stop);
    stop = true;
    EXPECT_EQ(error_of([&] { pair.next(stop); }).first, ExitCode::interrupted);
}

/// A bead of 1 kg on a rod from a fixed point, 1 m to one side.
const std::string bead = R"(
[[system.particle]]
name = "bead"
position_m = [0, 0]
[[system.constraint]]
kind = "rod"
from = "bead"
to = [1, 0]
)";

TEST(Size, OfOneParticleIsThatOfItsConstraint) {
    const auto scene = scene_from("[system]\nintegrator = \"rk4\"\nstep_s = \"1/1200\"" + bead);
    EXPECT_DOUBLE_EQ(scene.a.reach, 1);
    EXPECT_DOUBLE_EQ(scene.a.energy_unit, 2 * 9.8);
    // it starts with E = 0, and swings for half a minute
    PairRun pair(scene);
    double worst = 0;
    for (long n = 0; n <= scene.samples; ++n) worst = std::max(worst, std::abs(*pair.next(never).a.energy_error));
    EXPECT_LT(worst, 1e-7);  // measured 1.1e-8, the error of the method
}

TEST(Size, OfOneParticleMakesItsErrorsThoseOfTheSamePendulum) {
    // the same pendulum as a chain
    const auto particle = scene_from("[system]\naccuracy = 1e-6" + bead),
               chain = scene_from("[system]\nlinks = 1\nangle_deg = -90\naccuracy = 1e-6");
    ASSERT_TRUE(particle.a.choice && chain.a.choice);
    EXPECT_EQ(particle.a.choice->horizon, particle.samples);
    EXPECT_LT(particle.a.choice->estimated_error, 1e-6);
}

TEST(SideRun, FailsAtTenTimesTheTotalEnergy) {
    // it starts with E = 0: its kinetic energy equals the depth of its potential energy below the pivot
    const double rate = std::sqrt(2 * 9.8 * std::cos(0.3)), degree = pi / 180;
    const auto scene = scene_from(fmt::format(R"(
[scene]
sample_hz = 50
[system]
links = 1
angle_deg = {}
omega_deg_per_s = {}
integrator = "euler"
step_s = "1/50"
)",
                                              0.3 / degree, rate / degree));
    const auto motion = make_motion(scene.a.motion);
    EXPECT_NEAR(motion->observe().energy, 0, 1e-14);                // measured 1.8e-15
    const double maximum = 10 * (2 * 9.8 * 1 + 0.5 * rate * rate);  // the potential range, and the kinetic energy
    long sample = 0;
    for (; motion->observe().energy_change <= maximum; ++sample) motion->advance(never);
    SideRun run(scene, scene.a, 'a');
    for (long n = 0; n < sample; ++n) run.next(never);
    try {
        run.next(never);
        ADD_FAILURE();
    } catch (const RunFailure& error) {
        EXPECT_EQ(error.sample, sample);
    }
}

TEST(Distance, OverflowIsAnErrorOfTheStartOrTheMethod) {
    const auto error = [](const std::vector<std::string>& arguments, long sample) {
        const auto scene = scene_of("butterfly", arguments);
        auto moment = PairRun(scene).next(never);
        moment.sample = sample;
        return error_of([&] { check_distance(scene, moment); });
    };
    for (const auto* set : {"system.length_m=1e300", "a.mass_kg=[1, 1e200]"}) {
        const auto [code, words] = error({set}, 0);
        EXPECT_EQ(code, ExitCode::bad_input) << set;
        EXPECT_TRUE(says(words, "butterfly: side b differs from side a by more than 1e154 m, m/s or kg at t = 0 s: "));
        EXPECT_EQ(error({set}, 1).first, ExitCode::method_failed) << set;
    }
    EXPECT_EQ(error({"system.mass_kg=1e200"}, 0).first, ExitCode::done);
    EXPECT_EQ(error({}, 0).first, ExitCode::done);
}

/// Side a must fail at the first sample after its start, with these words.
void expect_failure_at_first_sample(const Scene& scene, const char* words) {
    SideRun run(scene, scene.a, 'a');
    run.next(never);
    const auto [code, message] = error_of([&] { run.next(never); });
    EXPECT_EQ(code, ExitCode::method_failed);
    EXPECT_TRUE(says(message, words));
}

TEST(SideRun, NamesTheVelocityThatIsNoNumber) {
    // a light mass on a stiff spring: its acceleration overflows, its energy does not
    const auto scene = scene_from(R"(
[system]
integrator = "euler"
step_s = "1/120"
[[system.particle]]
name = "mote"
mass_kg = 1e-10
position_m = [2, 2]
[[system.force]]
kind = "spring"
name = "spring"
from = "mote"
to = [0, 0]
length_m = 0
stiffness_N_per_m = 1e300
)");
    expect_failure_at_first_sample(scene, "the velocity in x of mass 1 is -inf");
}

TEST(SideRun, NamesTheRateThatIsNoNumber) {
    const auto scene = scene_from("[system]\nmass_kg = [1e-300, 1e300]");
    expect_failure_at_first_sample(scene, "the rate ω1 is not a number");
}

TEST(Mechanism, OfAChainStartsAsTheChainDoes) {
    const auto start = [](const std::string& model) {
        return make_motion(
                   scene_from("[system]\nlinks = 3\nangle_deg = [70, -20, 130]\nomega_deg_per_s = [40, -90, 25]\n"
                              "length_m = [1.5, 0.7, 0.4]\nmodel = \"" +
                              model + "\"")
                       .a.motion)
            ->observe();
    };
    const auto chain = start("angles"), parts = start("mechanism");
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &one = chain.bobs[i], &other = parts.bobs[i];
        for (const double off : {one.x - other.x, one.y - other.y, one.vx - other.vx, one.vy - other.vy})
            EXPECT_NEAR(off, 0, 3e-15) << i;  // measured 4.4e-16
    }
}

TEST(Ensemble, GoesFromOneSideToTheOtherInEqualSteps) {
    const auto scene = scene_of("fan", {"video.members=5", "a.angle_deg=[90, 40]", "b.angle_deg=[98, 20]",
                                        "a.mass_kg=[1, 1]", "b.mass_kg=[1, 3]"});
    ASSERT_EQ(scene.members.size(), 5u);
    for (int k = 0; k < 5; ++k) {
        const auto& chain = *scene.members[static_cast<std::size_t>(k)].chain;
        EXPECT_NEAR(static_cast<double>(chain.angle[0]), (90 + 2 * k) * pi / 180, 1e-15) << k;  // measured 0
        EXPECT_NEAR(static_cast<double>(chain.angle[1]), (40 - 5 * k) * pi / 180, 1e-15) << k;  // measured 0
        EXPECT_EQ(static_cast<double>(chain.mass[1]), 1 + 0.5 * k);
    }
}

TEST(Damping, IsNotAnEnergyError) {
    const auto scene = scene_from(R"(
[scene]
duration_s = 1
[system]
integrator = "rk4"
step_s = "1/1200"
[[system.particle]]
name = "bead"
position_m = [0, 0]
[[system.force]]
kind = "spring"
name = "spring"
from = "bead"
to = [1, 0]
stiffness_N_per_m = 20
[[b.force]]
name = "spring"
damping_N_s_per_m = 2
)");
    EXPECT_TRUE(scene.a.has_energy_error);
    EXPECT_FALSE(scene.b.has_energy_error);
    PairRun pair(scene);
    PairState last;
    for (long n = 0; n <= scene.samples; ++n) {
        last = pair.next(never);
        ASSERT_TRUE(last.a.energy_error);
        ASSERT_FALSE(last.b.energy_error);
    }
    EXPECT_LT(std::abs(*last.a.energy_error), 1e-11);  // measured 6e-13
    EXPECT_LT(last.b.energy_change, -1);               // measured -3.9 J
}

}  // namespace doppel::scene_test

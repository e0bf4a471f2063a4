#include "scene/method_choice.hpp"

#include "analysis/reference.hpp"
#include "base/threads.hpp"
#include "scene/drawn_scenes.hpp"
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <string>

namespace doppel::method_choice_test {

std::string error_of(const std::string& toml, const std::vector<std::string>& arguments = {}) {
    return test::thrown_by([&] { scene_from(toml, arguments); }).second;
}

/// The largest error of a side's run against quad, at all samples up to its horizon. `rounded`: against the motion of
/// the chain with its numbers rounded to double.
double true_error(const SideSpec& spec, const Side& side, bool rounded = false) {
    auto exact = spec;
    exact.accuracy.reset();
    exact.integrator = "taylor";
    exact.model = spec.is_mechanism() ? ModelChoice::mechanism : ModelChoice::angles;
    exact.precision = Precision::in_quad;
    exact.tolerance = parse_quad("1e-20");  // the least accuracy here is 1e-13
    auto motion = make_side(exact, {10, 1}).motion;
    motion.sample_interval = side.motion.sample_interval;
    if (rounded) motion.chain = motion.chain->cast<double>().cast<Quad>();
    const auto truth = make_motion(motion), run = make_motion(side.motion);
    double worst = 0;
    for (long sample = 0; sample <= side.choice->horizon; ++sample) {
        if (sample > 0) {
            truth->advance(never);
            run->advance(never);
        }
        const auto one = run->observe(), other = truth->observe();
        worst = std::max(worst, ErrorMeasure{side.has_angles, side.reach}.distance(one, other));
    }
    return worst;
}

TEST(Accuracy, TooManyStepsAreRefused) {
    EXPECT_TRUE(says(error_of("[system]\nmodel = \"constraints\"\ngravity_m_per_s2 = 1e50\naccuracy = 1e-6\n"),
                     "steps a sample"));
}

// a motor of 1e12 Hz takes some 1e11 steps a sample
TEST(Accuracy, IsInterruptedWhileAFastDriveIsStepped) {
    const auto scene = scene_from(
        "[system]\nintegrator = \"taylor\"\n[[system.torque]]\namplitude_N_m = 1\njoint = 1\nfrequency_hz = 1e6\n");
    const TimeLimit limit(0.1, never);
    SideRun run(scene, scene.a, 'a');
    EXPECT_THROW(for (int sample = 0; sample < 2; ++sample) run.next(limit.reached()), Error);
}

TEST(Choice, MeetsTheAccuracyAndEstimatesTheErrorOnRandomScenes) {
    const bool all = std::getenv("DOPPEL_ALL_SCENES");
    drawn::Lot lot(20261121);
    double most_optimistic = 0;
    for (const auto& kind : drawn::kinds) {
        const int enough = all || !kind.is_slow ? 6 : 0;
        double largest_share = 0;
        drawn::choose_for_each(kind, lot, enough, 12, 1, all ? 8 : 4, {10, 1},
                               [&](const Preset& preset, const Side& side) {
                                   const double error = true_error(preset.a, side);
                                   EXPECT_LE(error, side.choice->accuracy) << kind.name << ": " << side.method.name;
                                   most_optimistic = std::max(most_optimistic, error / side.choice->estimated_error);
                                   largest_share = std::max(largest_share, error / side.choice->accuracy);
                               });
        if (enough > 0) {
            EXPECT_GT(largest_share, 0.1) << kind.name;  // the estimate is not too cautious
        }
    }
    EXPECT_LT(most_optimistic, 1.001);  // measured 1.000000
}

TEST(Choice, MeetsTheAccuracyOfAMotionWhoseNumbersAreRoundedToDoubleToo) {
    // compared only with the exact decimals, round-off errors may cancel by chance: the error was 38 % too large here
    const auto scene = scene_from(
        "[scene]\nduration_s = 10\nsample_hz = 60\n[video]\nfps = 60\n[system]\nlinks = 3\nangle_deg = [76.79, 9.394, "
        "89.658]\nomega_deg_per_s = [175.67, 21.14, 388.1]\nlength_m = [1.112, 1.213, 1.443]\nmass_kg = [6.5504, "
        "0.3471, 6.1755]\naccuracy = 8.1e-10");
    EXPECT_LE(true_error(scene.preset.a, scene.a, true), scene.a.choice->accuracy);  // 3.2 times before the correction
}

TEST(Choice, MeetsTheAccuracyOfAMechanismInPartsOfItsSize) {
    // against dop853 in quad: 9.34e-6 m of 1.84 m up to the horizon of 4.78 s
    const auto scene = scene_from(
        "[scene]\nduration_s = 5\nsample_hz = 60\n[video]\nfps = 60\n[system]\naccuracy = 6.6e-06\n"
        "[[system.particle]]\nname = \"u\"\nmass_kg = 0.977\nposition_m = [0.682, -0.024]\n"
        "[[system.particle]]\nname = \"v\"\nmass_kg = 1.853\nposition_m = [-1.155, 0.075]\n"
        "[[system.constraint]]\nkind = \"slot-circle\"\nparticle = \"u\"\nposition_m = [0, 0]\n"
        "[[system.constraint]]\nkind = \"rod\"\nfrom = [-1, 0.6]\nto = \"v\"\n"
        "[[system.force]]\nkind = \"spring\"\nfrom = \"u\"\nto = \"v\"\nlength_m = 0.515\nstiffness_N_per_m = 44.881\n"
        "[[system.force]]\nkind = \"attraction\"\nfrom = \"u\"\nto = \"v\"\nconstant_m3_per_kg_s2 = 2.818\n");
    EXPECT_NEAR(scene.a.reach, 1.84, 0.01);
    EXPECT_LE(true_error(scene.preset.a, scene.a), 1.001 * scene.a.choice->estimated_error);  // 5.08e-6 of 5.19e-6
    EXPECT_LE(scene.a.choice->estimated_error, scene.a.choice->accuracy);
}

TEST(Choice, NeverTakesMoreWorkForLessAccuracy) {
    for (const char* system :
         {"angle_deg = [90, 90]", "angle_deg = [150, 90]", "angle_deg = [30, 0]", "links = 3\nangle_deg = [120, 0, 0]",
          "links = 1\nangle_deg = [170]", "mass_kg = [0.001, 1]", "angle_deg = [90, 90]\nmodel = \"constraints\""}) {
        auto preset = preset_from(fmt::format("[scene]\nduration_s = 12\n[system]\n{}\naccuracy = 1e-2", system));
        preset.sample_hz = {30, 1};
        MethodChooser chooser(preset, never);
        double before = 0;
        for (const double accuracy : {1e-1, 2e-2, 1e-2, 1e-3, 5e-4, 5e-5, 1e-6, 1e-7, 2e-8, 1e-9, 1e-10}) {
            try {
                const auto choice = *chooser.choose(accuracy / 1e-2, never)[0]->choice;
                if (choice.horizon < 360) break;  // from here on round-off decides
                EXPECT_GE(choice.work, before) << system << ", " << accuracy;
                before = choice.work;
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ExitCode::bad_input) << error.what();
                EXPECT_LT(accuracy, 1e-6) << system;
            }
        }
        EXPECT_GT(before, 0);
    }
}

TEST(Choice, KeepsTheAccuracyUpToTheHorizonWhereChaosLeavesNoMore) {
    // eight links, released level: errors grow tenfold within half a second
    const auto scene = scene_from("[scene]\nduration_s = 10\n[system]\nlinks = 8\nlength_m = 0.2\naccuracy = 1e-6");
    const auto& choice = *scene.a.choice;
    ASSERT_LT(choice.horizon, scene.samples);
    EXPECT_EQ(scene.a.motion.method, "taylor");
    EXPECT_GT(scene.a.motion.tolerance, 1e-14);  // the smallest is 1e-15; measured 3e-13, almost as long a horizon
    EXPECT_EQ(scene.horizon(), scene.time(choice.horizon));
    auto spec = scene.preset.a;
    spec.accuracy.reset();
    spec.integrator = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-22");
    const auto truth = make_motion(make_side(spec, scene.preset.sample_hz).motion), run = make_motion(scene.a.motion);
    double error = 0;
    const long past = choice.horizon + 120;  // one second later
    for (long sample = 1; sample <= past; ++sample) {
        truth->advance(never);
        run->advance(never);
        error = std::max(error, ErrorMeasure{}.distance(run->observe(), truth->observe()));
        if (sample == choice.horizon) {
            EXPECT_LE(error, choice.accuracy);
        }
    }
    EXPECT_GT(error, choice.accuracy);  // the horizon is not too short
}

TEST(Choice, KeepsTheUprightAsLongAsRoundingAllows) {
    // one link released at the double nearest to π: the difference from π grows as cosh(√(g/l) t)
    const auto scene = scene_from(
        "[scene]\nduration_s = 20\n[system]\nlinks = 1\nangle_deg = 180\nomega_deg_per_s = 0\naccuracy = 1e-3");
    const double lacking = 1.2246467991473532e-16, rounding = pi * 0x1p-53, rate = std::sqrt(9.8);
    const double exact = std::acosh(0.8e-3 / (lacking + rounding)) / rate;  // 80 % of the required accuracy
    EXPECT_NEAR(scene.time(scene.a.choice->horizon), exact, 0.1);           // measured 0.02; 9.22 s
}

TEST(Choice, TakesTheCheapestWayThatTheTableAllows) {
    const auto scene = [](const std::string& more) {
        return scene_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-6\n" + more);
    };
    EXPECT_EQ(scene("").a.motion.model, Model::angles);
    EXPECT_EQ(scene("model = \"constraints\"").a.motion.model, Model::constraints);
    EXPECT_EQ(scene("stabilise = \"projection\"").a.motion.model, Model::constraints);
    EXPECT_EQ(scene("[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [2, 0]").a.motion.model,
              Model::mechanism);
    // a higher accuracy costs more
    const auto loose = scene(""), tight = scene_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-11");
    EXPECT_LT(loose.a.choice->work, tight.a.choice->work);
    EXPECT_LT(tight.a.choice->estimated_error, loose.a.choice->estimated_error);
}

TEST(Choice, TakesMethodsThatSupportTheSystem) {
    const auto methods = [](const std::string& system) {
        const auto side = make_side(preset_from("[system]\nintegrator = \"dop853\"\n" + system).a, {10, 1});
        return fmt::format("{}", fmt::join(methods_for(side.motion), " "));
    };
    EXPECT_EQ(methods("links = 9"), "taylor");
    EXPECT_EQ(methods("rod_mass_kg = 1\nprecision = \"quad\""), "taylor");
    EXPECT_EQ(methods("rod_mass_kg = 1"), "dop853 dopri5 adams");
    EXPECT_EQ(methods("model = \"constraints\""), "dop853 dopri5 adams");
    EXPECT_EQ(methods("joint_coulomb_N_m = 0.1"), "dop853 dopri5");
    EXPECT_EQ(methods("model = \"mechanism\""), "dop853 dopri5 adams taylor");
}

TEST(Choice, IsSharedBySidesThatDifferOnlyInTheSystem) {
    const auto scene = [](const std::string& sides) {
        return scene_from("[scene]\nduration_s = 20\n[system]\naccuracy = 1e-6\n" + sides);
    };
    // alone, side a would get a tolerance three times as large
    const auto calm = scene("angle_deg = [20, 0]\n[b]\nangle_deg = [110, 0]");
    EXPECT_EQ(calm.a.motion.tolerance, calm.b.motion.tolerance);
    EXPECT_NE(calm.a.motion.tolerance, scene("angle_deg = [20, 0]").a.motion.tolerance);
    const auto heavy = scene("angle_deg = [20, 0]\n[b]\nrod_mass_kg = 0.001");
    EXPECT_EQ(heavy.a.motion.method, "dop853");
    EXPECT_EQ(heavy.b.motion.method, "dop853");
    EXPECT_EQ(heavy.a.motion.tolerance, heavy.b.motion.tolerance);
    // identical sides share one reference
    const auto same = scene("");
    EXPECT_EQ(same.a.choice->reference, same.b.choice->reference);
    // two sides of different accuracies need two choices
    const auto two = scene("angle_deg = [20, 0]\n[b]\naccuracy = 1e-3");
    EXPECT_LT(two.a.motion.tolerance, two.b.motion.tolerance);
}

TEST(Choice, IsOneForAllPairsOfASweep) {
    const auto alike = [](const std::string& system) {
        auto pair = preset_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-6\n" + system);
        use_common_method(pair, pair, never);
        EXPECT_FALSE(pair.a.accuracy || pair.b.accuracy) << system;
        EXPECT_EQ(pair.a.tolerance, pair.b.tolerance) << system;
        return fmt::format("{} {}", pair.a.integrator, text_of(*pair.a.tolerance));
    };
    EXPECT_EQ(alike(""), "taylor " + text_of(parse_quad("1e-15")));
    EXPECT_EQ(alike("links = 4\nangle_deg = 60"), "taylor " + text_of(parse_quad("1e-15")));
    EXPECT_EQ(alike("rod_mass_kg = 1"), "dop853 " + text_of(parse_quad("1e-14")));
    EXPECT_EQ(alike("precision = \"quad\""), "taylor " + text_of(parse_quad("1e-30")));
    auto far = preset_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-15");
    EXPECT_THROW(use_common_method(far, far, never), Error);
    // a side with a method of its own keeps it
    auto mixed = preset_from("[system]\naccuracy = 1e-6\n[b]\nintegrator = \"rk4\"");
    use_common_method(mixed, mixed, never);
    EXPECT_EQ(mixed.a.integrator, "taylor");
    EXPECT_EQ(mixed.b.integrator, "rk4");
}

TEST(Choice, TakesAsFineStepsAsItNeedsHoweverFewTheSamples) {
    const auto scene = make_scene(
        preset_from("[scene]\nduration_s = 3\nsample_hz = 1\n[video]\nfps = 1\n[system]\naccuracy = 1e-10\nmodel = "
                    "\"constraints\"\nangle_deg = 60"));
    EXPECT_EQ(scene.a.motion.method, "adams");
    EXPECT_EQ(scene.a.choice->horizon, 3);
    EXPECT_GE(scene.a.motion.steps_per_sample, 100);  // measured 128
}

TEST(Choice, GivesTolerancesOfOneOrThreeOfAPowerOfTen) {
    std::set<char> digits;
    for (int half_decades = 2; half_decades <= 10; ++half_decades) {
        const auto scene = make_scene(
            preset_from(fmt::format("[scene]\nduration_s = 2\n[system]\nangle_deg = [30, 0]\naccuracy = {:.3g}",
                                    std::pow(10, -0.5 * half_decades))));
        const double tolerance = static_cast<double>(scene.a.motion.tolerance);
        const auto digit = fmt::format("{:.0e}", tolerance);
        EXPECT_NEAR(std::stod(digit) / tolerance, 1, 1e-14);  // measured 0
        digits.insert(digit[0]);
    }
    EXPECT_EQ(digits, (std::set<char>{'1', '3'}));
}

TEST(Choice, ReplacesIntegratorAndStep) {
    const std::string euler =
        "[scene]\nduration_s = 1\n[system]\nintegrator = \"euler\"\nstep_s = \"1/1200\"\n[b]\nstep_s = \"1/2400\"";
    const auto by_accuracy = preset_from(euler, {"system.accuracy=1e-5"});
    EXPECT_TRUE(by_accuracy.a.accuracy && by_accuracy.b.accuracy && !by_accuracy.b.step_s);
    // the preset's keys apply table by table; the command line's method overrides the preset's accuracy
    const auto mixed = preset_from("[system]\naccuracy = 1e-5\n[b]\nintegrator = \"rk4\"");
    EXPECT_TRUE(mixed.a.accuracy && !mixed.b.accuracy);
    const auto by_method = preset_from("[system]\naccuracy = 1e-5", {"system.integrator=\"rk4\""});
    EXPECT_TRUE(!by_method.a.accuracy && by_method.a.integrator == "rk4");
    // and the resolved preset gives the same preset again
    EXPECT_EQ(resolved_toml(preset_from(resolved_toml(mixed))), resolved_toml(mixed));
    EXPECT_TRUE(says(resolved_toml(mixed), "accuracy = 1e-05\n"));
}

TEST(Choice, NamesAPossibleAccuracy) {
    EXPECT_EQ(error_of("[system]\naccuracy = 1e-6\nstep_s = 0.001"),
              "x.toml:2:1: [system] accuracy chooses integrator, step and tolerance; remove it, or step_s");
    EXPECT_EQ(error_of("[system]\naccuracy = 2"), "x.toml:2:1: [system] accuracy must be at most 1 rad; it is 2");
    EXPECT_EQ(error_of("[system]\naccuracy = 0"), "x.toml:2:1: [system] accuracy must be > 0; it is 0");
    const auto beyond = error_of("[scene]\nduration_s = 10\n[system]\naccuracy = 1e-15");
    EXPECT_EQ(beyond.find("x: side a: accuracy = 1e-15 rad is beyond double here: it would be kept for "), 0u)
        << beyond;
    EXPECT_TRUE(says(beyond, "; precision = \"quad\" allows more"));
    // the accuracy that the message calls possible for a chaotic motion is accepted
    const auto at = beyond.find("possible: ") + 10;
    const auto reachable = beyond.substr(at, beyond.find(' ', at) - at);
    EXPECT_EQ(error_of("[scene]\nduration_s = 10\n[system]\naccuracy = " + reachable), "no error");
    // so is the one that a regular motion keeps to the end
    const std::string gentle = "[scene]\nduration_s = 10\n[system]\nangle_deg = [30, 0]\naccuracy = ";
    const auto to_end = error_of(gentle + "1e-16");
    const auto end = to_end.find(" to the end;"), start = to_end.rfind(' ', end - 1);
    ASSERT_NE(end, std::string::npos) << to_end;
    EXPECT_EQ(error_of(gentle + to_end.substr(start, end - start)), "no error") << to_end;
    // a spring whose ends meet has no direction: the method fails, whatever the accuracy
    EXPECT_TRUE(
        says(error_of("[system]\naccuracy = 1e-6\n[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]"),
             "the reference fails within 0.0083 s: taylor:"));
    // so does the reference where the series of a light mass exceeds double
    const std::string bounce = "[scene]\nduration_s = 2\n[system]\naccuracy = 1e-2\nangle_deg = [100, -60]\nmass_kg = ";
    EXPECT_EQ(error_of(bounce + "[1e-9, 1]"), "no error");
    EXPECT_TRUE(says(error_of(bounce + "[1e-10, 1]"), "no accuracy can be verified, because the reference fails"));
    // the least error of all methods is possible, whatever is asked
    const auto possible = [&](const char* asked) {
        const auto words = error_of(bounce + "[1e-7, 1]\nmodel = \"mechanism\"", {asked});
        return words.substr(std::min(words.find("possible: "), words.size()));
    };
    const auto least = possible("system.accuracy=1e-12");
    EXPECT_EQ(least, possible("system.accuracy=1e-14"));
    EXPECT_EQ(least.find("possible: 2e-12 for 2 s"), 0u);
    const std::string particle = "[[system.particle]]\nname = \"p\"\nmass_kg = 1\nposition_m = [1, 0]\n";
    EXPECT_TRUE(says(error_of("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-17\n" + particle +
                              "[[system.constraint]]\nkind = \"rod\"\nfrom = \"p\"\nto = [0, 0]"),
                     "accuracy = 1e-17 of its size is beyond double"));
    EXPECT_EQ(error_of("[scene]\nduration_s = 5\n[system]\naccuracy = 1e-15\nprecision = \"quad\""), "no error");
}

}  // namespace doppel::method_choice_test

#include "scene/choice.hpp"

#include "analysis/angle_error.hpp"
#include "scene/choose.hpp"
#include "scene/resolved.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace doppel {
namespace {

const std::atomic<bool> never = false;

Preset preset_from(const std::string& toml, const std::vector<Override>& overrides = {}) {
    return read_preset({"test", "test.toml", toml}, overrides);
}

std::string fault_of(const std::string& toml, const std::vector<Override>& overrides = {}) {
    try {
        make_scene(preset_from(toml, overrides));
    } catch (const Error& fault) {
        return fault.what();
    }
    return "";
}

/// A system drawn by lot: chains of 1 to 4 unequal links, one in five on springs between the bobs and the wall.
SideSpec drawn(std::mt19937& lot) {
    const auto between = [&](double low, double high) {
        // whole thousandths, the same with every standard library
        return Quad(std::round(1000 * (low + (high - low) * static_cast<double>(lot()) / 4294967296.0))) / 1000;
    };
    SideSpec side;
    const std::size_t links = 1 + lot() % 4;
    for (auto* values : {&side.mass_kg, &side.length_m, &side.angle_deg, &side.omega_deg_per_s}) values->resize(links);
    for (std::size_t i = 0; i < links; ++i) {
        side.mass_kg[i] = between(0.2, 3);
        side.length_m[i] = between(0.3, 2);
        side.angle_deg[i] = between(-180, 180);
        side.omega_deg_per_s[i] = between(-200, 200);
    }
    side.gravity_m_per_s2 = between(1.6, 25);
    if (lot() % 5 == 0)
        side.forces.push_back({.name = "",
                               .kind = "spring",
                               .particle = "",
                               .from = EndSpec("bob1"),
                               .to = EndSpec(std::array<Quad, 2>{Quad(1), Quad(-1)}),
                               .stiffness_N_per_m = between(1, 30)});
    if (lot() % 4 == 0 && !side.is_mechanism()) side.model = ModelChoice::constraints;
    side.accuracy = Quad(1);
    for (int tenths = 2 + static_cast<int>(lot() % 9); tenths > 0; --tenths) *side.accuracy /= 10;
    return side;
}

/// The largest error of a side's run against quad, at all samples up to its horizon.
double true_error(const SideSpec& spec, const Side& side) {
    auto exact = spec;
    exact.accuracy.reset();
    exact.integrator = "taylor";
    exact.precision = Precision::in_quad;
    exact.tolerance = parse_quad("1e-24");
    const auto truth = make_motion(make_side(exact, {10, 1}).motion), run = make_motion(side.motion);
    double worst = 0;
    for (long sample = 0; sample <= side.choice->horizon; ++sample) {
        if (sample > 0) {
            truth->advance(never);
            run->advance(never);
        }
        worst = std::max(worst, angle_error(run->observe().bobs, truth->observe().exact));
    }
    return worst;
}

TEST(Choice, MeetsTheAccuracyAndEstimatesItOnFiftyScenesDrawnByLot) {
    std::mt19937 lot(20261121);
    int reached = 0;
    double most_optimistic = 0;
    for (int drawing = 0; reached < 50 && drawing < 80; ++drawing) {
        const auto spec = drawn(lot);
        const Rational seconds{1 + static_cast<long>(lot() % 5), 1};
        Side side;
        try {
            side = choose_side(spec, seconds, {10, 1}, never);
        } catch (const Error& fault) {
            EXPECT_EQ(fault.code(), ExitCode::bad_input) << fault.what();  // said to be out of reach
            continue;
        }
        ++reached;
        const double error = true_error(spec, side);
        EXPECT_LE(error, side.choice->accuracy) << drawing << ": " << side.method.name;
        most_optimistic = std::max(most_optimistic, error / side.choice->estimated_error);
    }
    EXPECT_EQ(reached, 50);
    EXPECT_LT(most_optimistic, 1.4);  // as the README says; measured 1.37
}

TEST(Choice, KeepsTheAccuracyUpToTheHorizonWhereChaosLeavesNoMore) {
    // eight links, let go level: errors grow tenfold within half a second
    const auto scene =
        make_scene(preset_from("[scene]\nduration_s = 10\n[system]\nlinks = 8\nlength_m = 0.2\naccuracy = 1e-6"));
    const auto& choice = *scene.a.choice;
    ASSERT_LT(choice.horizon, scene.samples);
    EXPECT_EQ(scene.horizon(), scene.time(choice.horizon));
    auto spec = scene.preset.a;
    spec.accuracy.reset();
    spec.integrator = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-28");
    const auto truth = make_motion(make_side(spec, scene.preset.sample_hz).motion), run = make_motion(scene.a.motion);
    double error = 0;
    const long past = choice.horizon + 120;  // a second later
    for (long sample = 1; sample <= past; ++sample) {
        truth->advance(never);
        run->advance(never);
        error = std::max(error, angle_error(run->observe().bobs, truth->observe().exact));
        if (sample == choice.horizon) {
            EXPECT_LE(error, choice.accuracy);
        }
    }
    EXPECT_GT(error, choice.accuracy);  // no horizon of caution alone
}

TEST(Choice, TakesTheCheapestWayThatTheTableAllows) {
    const auto scene = [](const std::string& more) {
        return make_scene(preset_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-6\n" + more));
    };
    EXPECT_EQ(scene("").a.motion.model, Model::angles);
    EXPECT_EQ(scene("model = \"constraints\"").a.motion.model, Model::constraints);
    EXPECT_EQ(scene("stabilise = \"projection\"").a.motion.model, Model::constraints);
    EXPECT_EQ(scene("[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [2, 0]").a.motion.model,
              Model::mechanism);
    // finer costs more
    const auto loose = scene(""),
               tight = make_scene(preset_from("[scene]\nduration_s = 2\n[system]\naccuracy = 1e-11"));
    EXPECT_LT(loose.a.choice->evaluations, tight.a.choice->evaluations);
    EXPECT_LT(tight.a.choice->estimated_error, loose.a.choice->estimated_error);
}

TEST(Choice, StandsInPlaceOfIntegratorAndStep) {
    const std::string euler =
        "[scene]\nduration_s = 1\n[system]\nintegrator = \"euler\"\nstep_s = \"1/1200\"\n[b]\nstep_s = \"1/2400\"";
    const auto by_accuracy = preset_from(euler, {parse_set("system.accuracy=1e-5")});
    EXPECT_TRUE(by_accuracy.a.accuracy && by_accuracy.b.accuracy && !by_accuracy.b.step_s);
    // what the preset says goes on top level by level; the command line's method beats the preset's accuracy
    const auto mixed = preset_from("[system]\naccuracy = 1e-5\n[b]\nintegrator = \"rk4\"");
    EXPECT_TRUE(mixed.a.accuracy && !mixed.b.accuracy);
    const auto by_method = preset_from("[system]\naccuracy = 1e-5", {parse_set("system.integrator=\"rk4\"")});
    EXPECT_TRUE(!by_method.a.accuracy && by_method.a.integrator == "rk4");
    // and what is resolved reads back to the same
    EXPECT_EQ(resolved_toml(preset_from(resolved_toml(mixed))), resolved_toml(mixed));
    EXPECT_NE(resolved_toml(mixed).find("accuracy = 1e-05\n"), std::string::npos) << resolved_toml(mixed);
}

TEST(Choice, SaysWhatIsWithinReach) {
    EXPECT_EQ(fault_of("[system]\naccuracy = 1e-6\nstep_s = 0.001"),
              "test.toml:2:1: [system] accuracy chooses integrator, step and tolerance itself; give it, or step_s");
    EXPECT_EQ(fault_of("[system]\naccuracy = 2"), "test.toml:2:1: [system] accuracy must be at most 1 rad; it is 2");
    EXPECT_EQ(fault_of("[system]\naccuracy = 0"), "test.toml:2:1: [system] accuracy must be > 0; it is 0");
    const auto beyond = fault_of("[scene]\nduration_s = 30\n[system]\naccuracy = 1e-15");
    EXPECT_EQ(beyond.find("test: side a: accuracy = 1e-15 rad is beyond double here: it would hold for "), 0u)
        << beyond;
    EXPECT_NE(beyond.find("; precision = \"quad\" reaches further"), std::string::npos) << beyond;
    // what it says is within reach for a swing, is
    const auto at = beyond.find("within reach are ") + 17;
    const auto reachable = beyond.substr(at, beyond.find(' ', at) - at);
    EXPECT_EQ(fault_of("[scene]\nduration_s = 30\n[system]\naccuracy = " + reachable), "");
    // a spring whose ends meet has no direction: that is the method's fault, not the accuracy's
    EXPECT_NE(fault_of("[system]\naccuracy = 1e-6\n[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]")
                  .find("breaks down within 0.0083 s: taylor:"),
              std::string::npos);
    EXPECT_EQ(fault_of("[scene]\nduration_s = 5\n[system]\naccuracy = 1e-15\nprecision = \"quad\""), "");
}

}  // namespace
}  // namespace doppel

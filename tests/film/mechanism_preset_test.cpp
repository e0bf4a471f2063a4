#include "film/film.hpp"
#include "film/support.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace doppel::mechanism_preset_test {

std::string error(const std::string& text) {
    const auto [code, message] = error_of([&] {
        const auto scene = scene_of_text(text);
        PairRun{scene};
    });
    EXPECT_EQ(code, ExitCode::bad_input) << text;
    return message;
}

const std::string bead = R"(
[system]
integrator = "rk4"
[[system.particle]]
name = "bead"
position_m = [1, 0]
)";

TEST(MechanismPreset, ABeadOnACircleIsThePendulum) {
    // the same motion by three models: angles, a chain, and a bead in a circular slot
    const auto scene = scene_of_text(bead + R"(
[[system.constraint]]
kind = "slot-circle"
particle = "bead"
position_m = [0, 0]
)");
    EXPECT_EQ(scene.a.motion.model, Model::mechanism);
    EXPECT_FALSE(scene.a.has_angles);
    const auto pendulum = scene_of_text("[system]\nlinks = 1\nintegrator = \"rk4\"");
    PairRun slot(scene), chain(pendulum);
    for (int n = 0; n <= 240; ++n) {
        const auto one = slot.next(never_stopped).a, other = chain.next(never_stopped).a;
        EXPECT_NEAR(one.bobs[0].x, other.bobs[0].x, 2e-13);  // measured 2.3e-14
        EXPECT_NEAR(one.bobs[0].vy, other.bobs[0].vy, 1e-12);
        EXPECT_LT(one.length_error, 3e-13);  // measured 5.1e-14
    }
}

TEST(MechanismPreset, ASideChangesByNameWhatTheSystemHas) {
    const auto scene = scene_of_text(bead + R"(
[[system.force]]
name = "pull"
kind = "spring"
from = "bead"
to = [0, 0]
stiffness_N_per_m = 3
[[b.particle]]
name = "bead"
position_m = [1.001, 0]
[[b.force]]
name = "pull"
stiffness_N_per_m = 4
[[b.force]]
kind = "spring"
from = "bead"
to = [0, 1]
)");
    EXPECT_EQ(scene.preset.a.forces.size(), 1u);
    EXPECT_EQ(scene.preset.b.forces.size(), 2u);
    EXPECT_EQ(scene.preset.b.forces[0].stiffness_N_per_m, 4);
    EXPECT_EQ(scene.preset.b.particles.size(), 1u);
    EXPECT_EQ(scene.preset.b.particles[0].position_m[0], parse_quad("1.001"));
    // a spring without a given rest length is relaxed at the start
    const auto& springs = scene.b.motion.parts->forces;
    EXPECT_EQ(std::get<Spring<Quad>>(springs[1]).length, parse_quad("1.001"));
}

TEST(MechanismPreset, AChainWithAFurtherForceKeepsItsAngles) {
    const auto scene = scene_of_text(R"(
[system]
integrator = "rk4"
angle_deg = [200, 90]
[[b.force]]
kind = "spring"
from = "bob2"
to = [0, -3]
)");
    EXPECT_EQ(scene.a.motion.model, Model::angles);
    EXPECT_EQ(scene.b.motion.model, Model::mechanism);
    const auto start = state_at(scene, 0);
    EXPECT_NEAR(start.b.bobs[0].theta, radians(200), 1e-15);  // measured 0
    EXPECT_LT(start.distance, 1e-15);                         // measured 1.7e-16
    EXPECT_GT(state_at(scene, 120).distance, 0.1);
}

TEST(MechanismPreset, SaysWhatIsWrongWithAPart) {
    const std::string two = bead + "[[system.particle]]\nname = \"bob\"\nposition_m = [0, 1]\n",
                      spring = "[[system.force]]\nname = \"pull\"\nkind = \"spring\"\nfrom = \"bead\"\nto = [0, 3]\n",
                      rod = bead + "[[system.constraint]]\nkind = \"rod\"\n";
    const std::pair<std::string, std::string> errors[] = {
        // both sides have the same particles in the same order
        {two + "[[b.particle]]\nname = \"bob\"\nposition_m = [0, 2]\n[[b.particle]]\nname = \"baed\"",
         "presets/x.toml:10:5: [b] particle must be those of side a in their order, bead, bob, to be compared; they "
         "are "
         "bead, bob, baed"},
        {"[[a.particle]]\nname = \"one\"\n[[a.particle]]\nname = \"two\"\n[[b.particle]]\nname = \"one\"",
         "presets/x.toml:5:5: [b] particle must be those of side a in their order, one, two, to be compared; they are "
         "one"},
        {"[[a.particle]]\nname = \"one\"\n[[a.particle]]\nname = \"two\"\nposition_m = [1, 0]\n"
         "[[b.particle]]\nname = \"two\"\n[[b.particle]]\nname = \"one\"\nposition_m = [1, 0]",
         "presets/x.toml:6:5: [b] particle must be those of side a in their order, one, two, to be compared; they are "
         "two, one"},
        // two particles with the same name
        {bead + "[[system.particle]]\nname = \"bead\"\nposition_m = [0, 1]",
         R"(presets/x.toml:8:1: [[system.particle]] 2 name must be unique; "bead" is used already)"},
        {bead + spring + spring,
         R"(presets/x.toml:13:1: [[system.force]] 2 name must be unique; "pull" is used already)"},
        {"[[system.particle]]\nmass_kg = 1",
         "presets/x.toml:1:1: [[system.particle]] 1 name is missing; constraints and forces refer to a particle by it"},
        {bead + "[[system.constraint]]\nkind = \"rope\"",
         R"(presets/x.toml:8:1: [[system.constraint]] 1 kind must be "anchor", "rod", "slot-line" or "slot-circle"; it is "rope"; did you mean "rod"?)"},
        {bead + "[[system.force]]\nfrom = \"bead\"",
         R"(presets/x.toml:7:1: [[system.force]] 1 kind is missing; there is "spring", "attraction", "droplet")"},
        {rod + "from = \"bead\"", "presets/x.toml:7:1: [[system.constraint]] 1 to is missing; a rod needs it"},
        {rod + "from = \"bead\"\nto = [0, 0]\nstiffness_N_per_m = 2",
         R"(presets/x.toml:11:1: [[system.constraint]] 1 has no "stiffness_N_per_m"; it has from, kind, length_m, name, to)"},
        {rod + "from = \"baed\"\nto = [0, 0]",
         R"(presets/x.toml:9:1: [[system.constraint]] 1 from must name a particle; there is no "baed"; did you mean "bead"?)"},
        {rod + "from = [1, 0]\nto = [0, 0]",
         "presets/x.toml:10:1: [[system.constraint]] 1 to must name a particle, because from is a fixed place"},
        {"[system]\nlinks = 2\n[[system.particle]]\nname = \"a\"",
         "presets/x.toml:2:1: [system] links describes a chain, but [[system.particle]] describes another system; "
         "remove one of them"},
        // a chain that particles would replace
        {"[system]\nangle_deg = [30, 30]\n[[a.particle]]\nname = \"bob1\"",
         "presets/x.toml:3:5: [a] particle describes another system than the chain of [system] angle_deg; remove one "
         "of them, or give that key in the other side"},
        {bead + "[[system.force]]\nkind = \"attraction\"\nfrom = \"bead\"\nto = [1, 0]",
         R"(presets/x.toml:10:1: [[system.force]] 1 to must name a particle; for a fixed body use a "droplet")"},
        {"[system]\nintegrator = \"gauss4\"\n[[system.particle]]\nname = \"a\"",
         R"(presets/x.toml:2:1: [system] integrator "gauss4" supports angles, not a mechanism)"},
        {"[system]\nmodel = \"angles\"\n[[system.particle]]\nname = \"a\"",
         R"(presets/x.toml:2:1: [system] model must be "mechanism" or "auto" with particles, constraints or forces; it is "angles")"},
        {"[system]\nparticle = 3",
         "presets/x.toml:2:1: [system] particle must be written as [[system.particle]] tables; it is a whole "
         "number (3)"}};
    for (const auto& [text, message] : errors) EXPECT_EQ(error(text), message) << text;
    // errors of the mechanism itself name its side
    const auto off = error(rod + "from = \"bead\"\nto = [0, 0]\nlength_m = 1.5");
    EXPECT_TRUE(off.starts_with("x: side a: constraint 1 (rod 1–fixed): ")) << off;
}

TEST(MechanismPreset, ADropletBelowDoublePrecisionNeedsQuad) {
    const std::string text = R"(
[system]
angle_deg = [79, 79]
integrator = "rk4"
[[b.force]]
kind = "droplet"
position_m = [1609, 0]
mass_kg = 3.4e-5
)";
    EXPECT_EQ(
        error(text),
        "x: the droplet attracts with 8.8e-22 m/s², below the rounding of g in double (1.8e-15): both sides would move "
        "identically. Set precision = \"quad\"");
    auto preset =
        read_preset({"x", "presets/x.toml", text}, sets({"system.precision=\"quad\"", "system.model=\"mechanism\""}));
    const auto scene = make_scene(preset);
    const double distance = state_at(scene, 1).distance;
    // both masses hang on one line: 8.8e-22 m/s² · cos 79° perpendicular to it, for 1/120 s
    const double pull = 6.674e-11 * 3.4e-5 / (1609 * 1609);
    EXPECT_NEAR(distance / (std::sqrt(2.0) * pull * std::cos(radians(79)) / 120), 1, 0.01);  // measured 1.0002
}

}  // namespace doppel::mechanism_preset_test

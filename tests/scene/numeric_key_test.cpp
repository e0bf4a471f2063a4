#include "scene/numeric_key.hpp"

#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel::numeric_key_test {

const std::string springs = R"(
[system]
angle_deg = [90, 80]
[b]
mass_kg = [1, 2]
[[system.force]]
kind = "spring"
name = "left"
from = "bob1"
to = [-1, 0]
stiffness_N_per_m = 5
[[system.force]]
kind = "spring"
from = "bob2"
to = [1, 0]
stiffness_N_per_m = 5
damping_N_s_per_m = 0.1
[[system.constraint]]
kind = "slot-line"
particle = "bob2"
direction = [1, 0]
)";

/// The result of looking up a key, with the keys of a preset.
struct Found {
    Preset preset;
    std::optional<NumericKey> key;
    std::string message;

    Found(const std::string& path, const std::string& text = "", bool reads_springs = false) {
        const PresetText source{"x", "x.toml", "[sweep]\nparameter = 1\n" + text};
        preset = preset_from(reads_springs ? springs : text);
        const auto document = parse_document(source, {});
        TomlReader top(&document.root, "", document.path, document.texts);
        auto table = top.inner("sweep");
        message = error_of([&] { key.emplace(table, "parameter", path, preset); }).second;
    }
    Preset with(double value, double difference = 0) {
        auto changed = preset;
        key->set(changed, Quad(value), Quad(difference));
        return changed;
    }
};

TEST(NumericKey, OfBothSidesSetsBothAndTheDifferenceOfB) {
    Found gravity("system.gravity_m_per_s2");
    ASSERT_TRUE(gravity.key) << gravity.message;
    EXPECT_EQ(gravity.key->label, "gravity, m/s²");
    const auto set = gravity.with(3, 0.5);
    EXPECT_EQ(set.a.gravity_m_per_s2, 3);
    EXPECT_EQ(set.b.gravity_m_per_s2, Quad(3.5));
}

TEST(NumericKey, OfAnElementLeavesTheOthers) {
    Found mass("b.mass_kg[1]");
    ASSERT_TRUE(mass.key) << mass.message;
    EXPECT_EQ(mass.key->label, "mass m₂ of side b, kg");
    const auto set = mass.with(7);
    EXPECT_EQ(set.b.mass_kg, (std::vector<Quad>{1, 7}));
    EXPECT_EQ(set.a.mass_kg, (std::vector<Quad>{1, 1}));
    Found all("system.length_m");
    EXPECT_EQ(all.with(2).a.length_m, (std::vector<Quad>{2, 2}));
}

TEST(NumericKey, OfAListThatIsNotGivenFillsAllLinks) {
    for (const auto& [path, text] : std::vector<std::pair<std::string, std::string>>{
             {"system.center_m", ""}, {"a.center_m", ""}, {"a.center_m", "[system]\nlinks = 3\n"}}) {
        Found center(path, text);
        ASSERT_TRUE(center.key) << center.message;
        const auto set = center.with(0.5);
        EXPECT_EQ(set.a.physical.center_m, std::vector<Quad>(set.a.links(), Quad(0.5))) << path << text;
        EXPECT_EQ(set.b.physical.center_m.empty(), path == "a.center_m") << path;
    }
}

TEST(NumericKey, HasTheRangeThatAFilmAccepts) {
    const auto least = [](const std::string& path, const std::string& text) {
        return Found(path, "[system]\n" + text).key->bounds.is_open;
    };
    const std::string rods = "rod_mass_kg = [0, 1]\n", ends = "mass_kg = [0, 1]\nrod_mass_kg = [1, 1]\n";
    EXPECT_FALSE(least("system.mass_kg[1]", rods));
    EXPECT_FALSE(least("system.mass_kg", ends));
    EXPECT_FALSE(least("b.rod_mass_kg[1]", ends));
    EXPECT_TRUE(least("system.mass_kg[0]", rods));
    EXPECT_TRUE(least("system.mass_kg", rods));
    EXPECT_TRUE(least("a.rod_mass_kg", ends));
    EXPECT_TRUE(least("system.mass_kg", "rod_mass_kg = 1\n[a]\nrod_mass_kg = 0\n"));
    EXPECT_TRUE(least("system.gravity_m_per_s2", ""));
    EXPECT_FALSE(Found("system.gravity_m_per_s2", "", true).key->bounds.is_open);
}

TEST(NumericKey, OfAnEntryIsFoundByNameOrByItsKind) {
    Found left("system.force.left.stiffness_N_per_m", "", true);
    ASSERT_TRUE(left.key) << left.message;
    EXPECT_EQ(left.key->label, "stiffness of left, N/m");
    const auto stiffness = [](const SideSpec& side, std::size_t i) { return side.forces[i].stiffness_N_per_m; };
    const auto set = left.with(50);
    EXPECT_EQ(stiffness(set.a, 0), 50);
    EXPECT_EQ(stiffness(set.b, 0), 50);
    EXPECT_EQ(stiffness(set.a, 1), 5);
    Found line("system.constraint.slot-line.direction[1]", "", true);
    ASSERT_TRUE(line.key) << line.message;
    EXPECT_EQ(line.with(0.5).a.constraints[0].direction[1], Quad(0.5));
    // two springs: the key is ambiguous
    EXPECT_TRUE(
        says(Found("system.force.spring.stiffness_N_per_m", "", true).message, "no particle, constraint or force"));
}

TEST(NumericKey, OfLinksKeepsWhatAllLinksHaveInCommon) {
    const Found unequal("system.links", "[system]\nlinks = 2\nangle_deg = 120\nlength_m = [1, 2]\n");
    EXPECT_TRUE(says(unequal.message, "needs links that are all equal; length_m has different numbers"));
    Found links("system.links", "[system]\nlinks = 2\nangle_deg = 120\nlength_m = 3\n");
    ASSERT_TRUE(links.key) << links.message;
    EXPECT_TRUE(links.key->is_whole);
    const auto set = links.with(4);
    EXPECT_EQ(set.a.angle_deg, (std::vector<Quad>(4, 120)));
    EXPECT_EQ(set.a.length_m, (std::vector<Quad>(4, 3)));
    Found rods("system.links", "[system]\nlinks = 2\nrod_mass_kg = 0.5\ncenter_m = 0.3\n");
    EXPECT_EQ(rods.with(3).a.physical.rod_mass_kg, (std::vector<Quad>(3, Quad(1) / 2)));
    EXPECT_EQ(rods.with(3).a.physical.center_m, (std::vector<Quad>(3, parse_quad("0.3"))));
}

TEST(NumericKey, OfAStepTakesTheNearestThatDividesASample) {
    Found step("system.step_s", "[system]\nintegrator = \"rk4\"\n");
    ASSERT_TRUE(step.key) << step.message;
    EXPECT_TRUE(step.key->is_step);
    EXPECT_EQ(step.with(1.0 / 1000).a.step_s, (Rational{1, 960}));  // 8 steps in a sample of 1/120 s
    EXPECT_EQ(step.key->taken(Quad(1.0 / 1000), step.preset), Quad(1) / 960);
    EXPECT_FALSE(step.key->keeps_method);
    EXPECT_NEAR(step.key->bounds.high, 1.0 / 120, 1e-7);  // a sample
}

TEST(NumericKey, IsRefusedWithWhatWouldBeRight) {
    const auto refused = [](const std::string& path, const std::string& words, const std::string& text = "") {
        const Found found(path, text);
        EXPECT_TRUE(says(found.message, words)) << path << ": " << found.message;
        EXPECT_TRUE(found.message.starts_with("x.toml:2:1: [sweep] parameter ")) << found.message;
    };
    refused("gravity", "system.gravity_m_per_s2");
    refused("system.gravity", "there are links, mass_kg, length_m, angle_deg, omega_deg_per_s, rod_mass_kg, ");
    refused("system.model", "is not a number");
    refused("system.mass_kg[2]", "whose last element is [1]");
    refused("system.mass_kg[x]", "must end like");
    refused("system.gravity_m_per_s2[0]", "is a number, not an array");
    refused("system.force.wind.mass_kg", "names no particle, constraint or force");
    refused("system.tolerance", "uses step_s");
    refused("system.step_s", "uses tolerance", "[system]\nintegrator = \"dop853\"\n");
    refused("system.accuracy", "needs an accuracy in the preset");
    refused("scene.duration_s", "must be a numeric key");
    refused("system.", "must be a numeric key");
}

}  // namespace doppel::numeric_key_test

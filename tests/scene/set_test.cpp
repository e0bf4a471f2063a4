// The values of --set: without quotes, elements of lists, entries by name.
#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel::set_test {

using Texts = std::vector<std::string>;

const std::string mechanism = R"(
[[system.particle]]
name = "left"
mass_kg = 1
position_m = [1, 0]
[[system.constraint]]
kind = "rod"
from = "left"
to = [0, 0]
length_m = 1
[[system.force]]
name = "tie"
kind = "spring"
from = "left"
to = [2, 0]
stiffness_N_per_m = 6
length_m = 1
[b]
gravity_m_per_s2 = 9
)";

TEST(Set, IsTheSameAsTheLongForm) {
    struct Case {
        const char* preset;
        Texts brief, whole;
    };
    const std::vector<Case> cases{
        {"", {"video.theme=light"}, {"video.theme=\"light\""}},
        {"", {"system.step_s=1/2400"}, {"system.step_s=\"1/2400\""}},
        {"", {"title=Two of them"}, {"title=\"Two of them\""}},
        {"", {"title=system.mass_kg[1]"}, {"title=\"system.mass_kg[1]\""}},
        {"",
         {"video.layout=portrait", "video.panels=pendulums"},
         {"video.layout=\"portrait\"", "video.panels=[\"pendulums\"]"}},
        {"[system]\nlinks = 1\n[video]\nlayout = \"ensemble\"",
         {"video.members=[30, 60, 90]"},
         {"video.members=[[30], [60], [90]]"}},
        {"[system]\nmass_kg = [1, 1]", {"system.mass_kg[1]=2"}, {"system.mass_kg=[1, 2]"}},
        {"", {"system.mass_kg[0]=2", "system.mass_kg[1]=3"}, {"system.mass_kg=[2, 3]"}},
        {"[system]\nmass_kg = 5", {"system.mass_kg[1]=2"}, {"system.mass_kg=[5, 2]"}},
        {"[system]\nlinks = 3", {"system.angle_deg[2]=10"}, {"system.angle_deg=[90, 90, 10]"}},
        {"[system]\nmass_kg = [1.5, 2.5]", {"b.mass_kg[0]=2"}, {"b.mass_kg=[2, 2.5]"}},
        {"",
         {"system.rod_mass_kg[0]=1", "system.mass_kg=[0, 1]"},
         {"system.rod_mass_kg=[1, 0]", "system.mass_kg=[0, 1]"}},
        {"", {"video.size[0]=1280"}, {"video.size=[1280, 1080]"}},
        {"",
         {"video.show[0]=clock"},
         {"video.show=[\"clock\", \"subtitle\", \"clock\", \"labels\", \"credit\", \"rods\", \"bobs\", \"circle\", "
          "\"twin\"]"}},
        {"[system]\nprecision = \"quad\"\nangle_deg = [0.1234567890123456789012345678, 1]",
         {"system.angle_deg[1]=2"},
         {"system.angle_deg=[0.1234567890123456789012345678, 2]"}},
    };
    for (const auto& [preset, brief, whole] : cases)
        EXPECT_EQ(resolved_toml(preset_from(preset, brief)), resolved_toml(preset_from(preset, whole))) << brief[0];
}

TEST(Set, AListOfOneNeedsNoBracketsInAFileEither) {
    for (const auto& [brief, whole] : std::vector<std::pair<const char*, const char*>>{
             {"[video]\npanels = \"pendulums\"", "[video]\npanels = [\"pendulums\"]"},
             {"[system]\nlinks = 1\n[video]\nlayout = \"ensemble\"\nmembers = [30, 60, 90]",
              "[system]\nlinks = 1\n[video]\nlayout = \"ensemble\"\nmembers = [[30], [60], [90]]"}})
        EXPECT_EQ(resolved_toml(preset_from(brief)), resolved_toml(preset_from(whole))) << brief;
}

TEST(Set, ReachesEntriesByTheirNamesOrTheOnlyOneOfAKind) {
    for (const auto* key : {"system.force.tie", "system.force.spring"}) {
        const auto preset = preset_from(mechanism, {std::string(key) + ".stiffness_N_per_m=3"});
        EXPECT_TRUE(says(resolved_toml(preset), "stiffness_N_per_m = 3\n"));
    }
    EXPECT_EQ(preset_from(mechanism, {"system.particle.left.mass_kg=2"}).b.particles.at(0).mass_kg, 2);
    EXPECT_EQ(preset_from(mechanism, {"system.particle.left.position_m[1]=0.5"}).a.particles.at(0).position_m[1], 0.5);
    const auto b = preset_from(mechanism, {"b.particle.left.mass_kg=2"});
    EXPECT_EQ(b.a.particles.at(0).mass_kg, 1);
    EXPECT_EQ(b.b.particles.at(0).mass_kg, 2);
}

TEST(Set, ErrorsNameWhatWouldBeRight) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"system.angle_deg=60,60", "a list needs brackets: 'system.angle_deg=[60,60]'"},
        {"video.theme=blue", "[video] theme must be \"dark\", \"light\" or \"high-contrast\"; it is \"blue\""},
        {"scene.duration_s=long",
         "[scene] duration_s must be a number or a fraction such as \"1/30000\"; it is \"long\""},
        {"scene.duration_s=9s", "\"9s\" is not a TOML value"},
        {"system.angle_deg=1e400", "\"1e400\" is not a TOML value"},
        {"title=a \"b", "a list is like [1, 2], and a string needs quotes: 'title=\"…\"'"},
        {"system.mass_kg[2]=1", "[system] mass_kg[2] is beyond the list, whose last element is [1]"},
        {"system.mass_kg[x]=1", "is written like system.mass_kg[1], the second"},
        {"system.mass_kg[0]=a", "[system] mass_kg[0] must be a number; it is a string (\"a\")"},
        {"system.mass_kg[0]=-1", "[system] mass_kg[0] must be > 0; it is -1"},
        {"system.center_m[0]=1",
         "[system] center_m[0] is an element of a list that the preset does not have; give the whole list"},
        {"video.contact_sheet[1]=1",
         "[video] contact_sheet[1] is an element of a list that the preset does not have; give the whole list"},
        {"video.size[0]=1", "[video] size[0] must be from 64 to 16384 px; it is 1"},
        {"system.model[0]=1", "[system] model[0] is not an element of a list of numbers"},
        {"system.gravity_m_per_s2[0]=1", "[system] gravity_m_per_s2[0] is not an element of a list of numbers"},
    };
    const auto expect_refusal = [](const std::string& text, const std::string& set, const std::string& words) {
        EXPECT_TRUE(says(refusal([&] { preset_from(text, {set}); }), words)) << set;
    };
    for (const auto& [set, words] : cases) expect_refusal("[system]\nmodel = \"angles\"", set, words);
    for (const auto& [set, words] : std::vector<std::pair<std::string, std::string>>{
             {"system.force.rope.length_m=1", "[[system.force]] has no entry \"rope\"; there are tie"},
             {"system.constraint.rope.length_m=1",
              "[[system.constraint]] has no entry \"rope\"; give the entry a name in the preset"},
             {"b.force.rope.length_m=1", "[[b.force]] has no entry \"rope\""},
             {"system.force.tie.stiffnes_N_per_m=1",
              "has no \"stiffnes_N_per_m\"; did you mean \"stiffness_N_per_m\"?"}})
        expect_refusal(mechanism, set, words);
    // a complete list replaces its elements that were set before
    EXPECT_TRUE(says(refusal([] {
                         preset_from("", {"system.mass_kg[0]=2", "system.mass_kg=[1, 1]"});
                     }),
                     "would remove --set system.mass_kg[0]"));
}

TEST(Set, DrivesHaveFrequenciesThatAPendulumFollows) {
    for (const auto* set :
         {"system.pivot.frequency_hz=1e300", "system.torque=[{amplitude_N_m = 1, frequency_hz = 1e300}]"})
        EXPECT_TRUE(says(refusal([&] { preset_from("[system.pivot]\namplitude_m = 0.1", {set}); }),
                         "1000000 Hz; it is 1e+300"));
}

}  // namespace doppel::set_test

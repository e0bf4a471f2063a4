// The texts of pictures and messages.
#include "scene/captions.hpp"

#include "scene/resolved.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

#include <array>

namespace doppel::captions_test {

TEST(Captions, RoundSingleMeasurements) {
    EXPECT_EQ(two_digits(0.1234), "0.12");
    EXPECT_EQ(two_digits(1.26), "1.3");
    EXPECT_EQ(two_digits(9.96), "10");
    EXPECT_EQ(two_digits(96.4), "96");
    EXPECT_EQ(two_digits(223456), "220 000");
    EXPECT_EQ(two_digits(2345), "2300");
    EXPECT_EQ(with_digits(12.345, 3), "12.3");
    EXPECT_EQ(with_digits(1234.5, 3), "1230");
    EXPECT_EQ(with_digits(999.9, 3), "1000");
    EXPECT_EQ(scientific(523), "520");
    EXPECT_EQ(scientific(0.1), "0.1");
    EXPECT_EQ(scientific(1234), "1.2 × 10³");
    EXPECT_EQ(grouped(2400), "2400");
    EXPECT_EQ(grouped(30000), "30 000");
}

TEST(Captions, StateTheDifferenceOfASideAsFarAsItFits) {
    const auto few = side_captions(scene_of("butterfly"));
    EXPECT_EQ(few[0].heading, "θ₁ = 90°");
    EXPECT_EQ(few[0].note, "θ₂ = 90°");
    const auto many = side_captions(scene_of("butterfly", {"b.omega_deg_per_s=[1, 2]", "b.mass_kg=[3, 4]",
                                                           "b.length_m=[0.5, 0.6]", "b.gravity_m_per_s2=9.7"}));
    EXPECT_EQ(many[1].heading, "θ₁ = 90.003°, ω₁ = 1°/s");
    EXPECT_EQ(many[1].note, "ω₂ = 2°/s, m₁ = 3 kg, m₂ = 4 kg, …");
    // with as many digits as distinguish the sides
    const auto fitted = side_captions(scene_of(
        "butterfly", {"a.angle_deg=[-68.74868958, -314.1588569]", "b.angle_deg=[-68.75168958, -314.1588569]"}));
    EXPECT_EQ(fitted[0].heading, "θ₁ = −68.7487°");
    EXPECT_EQ(fitted[1].heading, "θ₁ = −68.7517°");
    EXPECT_EQ(fitted[1].note, "θ₂ = −314.159°");
    const auto near = side_captions(scene_of("butterfly", {"b.angle_deg=[90.0000000015, 90]"}));
    EXPECT_EQ(near[1].heading, "θ₁ = 90.0000000015°");
}

TEST(Captions, AreThePresetsIfItSetsThem) {
    const auto own = scene_of("butterfly", {"a.label=\"left\"", "b.note=\"\"", "subtitle=\"by me\""});
    EXPECT_EQ(scene_caption(own), "by me");
    const auto sides = side_captions(own);
    EXPECT_EQ(sides[0].heading, "left");
    EXPECT_EQ(sides[0].note, "θ₁ = 90°, θ₂ = 90°");  // the difference moves into the note: the label replaces it above
    EXPECT_EQ(sides[1].heading, "θ₁ = 90.003°");
    EXPECT_EQ(sides[1].note, "");
    // they are in the resolved preset, and allowed only for the sides of a film
    const auto again = preset_from(resolved_toml(own.preset));
    EXPECT_EQ(again.a.label, "left");
    EXPECT_EQ(again.b.note, "");
    EXPECT_EQ(again.b.label, std::nullopt);
    EXPECT_EQ(again.subtitle, "by me");
    const auto error = [](const char* set) { return refusal([&] { scene_of("butterfly", {set}); }); };
    EXPECT_TRUE(says(error("system.label=\"x\""), "[system] has no \"label\""));
    EXPECT_TRUE(says(error("b.label=\"\xcd\xb8\""), "[b] label contains \"\xcd\xb8\""));
}

TEST(Captions, OfAnAccuracyOmitTheChosenTolerance) {
    // the angles of the sides differ by 10⁻¹²°, and each side gets its own tolerance
    const auto scene = scene_of("horizon", {"scene.duration_s=5"});
    for (const auto& side : side_captions(scene)) {
        EXPECT_EQ(side.heading.find("tolerance"), std::string::npos) << side.heading;
        EXPECT_EQ(side.note, "θ₂ = 90°");
    }
    EXPECT_TRUE(scene_caption(scene).ends_with("accuracy 0.01 rad")) << scene_caption(scene);
    // a tolerance that the preset states is shown
    const auto given = side_captions(scene_of(
        "butterfly", {"system.integrator=\"taylor\"", "a.tolerance=1e-9", "b.tolerance=1e-12", "b.angle_deg=90"}));
    EXPECT_EQ(given[0].heading, "tolerance 10⁻⁹");
    // two different accuracies are shown, too
    const auto two = side_captions(scene_of("horizon", {"scene.duration_s=2", "a.accuracy=1e-3", "b.angle_deg=90"}));
    EXPECT_EQ(two[0].heading, "accuracy 0.001 rad");
    EXPECT_EQ(two[1].heading, "accuracy 0.01 rad");
}

TEST(Captions, OfMechanismsSayWhatDiffers) {
    // as the presets say it, and as it is said without their labels and notes
    auto springs = scene_of("springs"), loop = scene_of("loop", {"b.particle.bob.mass_kg=2"});
    EXPECT_EQ(side_captions(springs)[0].heading, "bead and middle in place");
    EXPECT_EQ(side_captions(springs)[1].heading, "bead and middle 1 mm to the right");
    EXPECT_EQ(side_captions(loop)[0].heading, "bob at rest");
    EXPECT_EQ(side_captions(loop)[1].heading, "bob pushed at 1 mm/s");
    for (auto* scene : {&springs, &loop})
        for (auto* side : {&scene->preset.a, &scene->preset.b}) side->label = side->note = std::nullopt;
    EXPECT_EQ(side_captions(springs)[0].heading, "\"bead\" position (0, 0) m, \"middle\" position (0.8, 0.6) m");
    EXPECT_EQ(side_captions(springs)[1].heading, "\"bead\" position (0.001, 0) m, \"middle\" position (0.801, 0.6) m");
    EXPECT_EQ(side_captions(loop)[0].heading, "\"bob\" mass 1 kg, \"bob\" velocity (0, 0) m/s");
    EXPECT_EQ(side_captions(loop)[1].heading, "\"bob\" mass 2 kg, \"bob\" velocity (0.0006, -0.0008) m/s");
}

TEST(Captions, NeverCallSidesTheSameThatDiffer) {
    const auto headings = [](const std::string& text) {
        const auto said = side_captions(scene_from(text));
        return said[0].heading + " | " + said[1].heading;
    };
    const std::string bead =
        "[system]\nintegrator = \"rk4\"\n[[system.particle]]\nname = \"u\"\n[[system.force]]\nkind = \"spring\"\n"
        "name = \"s\"\nfrom = \"u\"\nto = [0, 2]\n[[system.constraint]]\nkind = \"slot-line\"\nname = \"rail\"\n"
        "particle = \"u\"\n";
    EXPECT_EQ(headings(bead + "[[b.force]]\nname = \"s\"\nstiffness_N_per_m = 2"),
              "spring \"s\" stiffness 1 N/m | spring \"s\" stiffness 2 N/m");
    EXPECT_EQ(headings(bead + "[[b.force]]\nkind = \"spring\"\nfrom = \"u\"\nto = [1, 0]"),
              "no spring 2 | with spring 2 of stiffness 1 N/m");
    EXPECT_EQ(headings(bead + "[[b.force]]\nkind = \"droplet\"\nmass_kg = 1000\nposition_m = [3, 1]"),
              "no droplet 1 | with droplet 1 of position (3, 1) m and mass 1000 kg");
    EXPECT_EQ(headings(bead + "[[b.constraint]]\nname = \"rail\"\ndirection = [1, 0.5]"),
              "slot-line \"rail\" direction (1, 0) | slot-line \"rail\" direction (1, 0.5)");
    EXPECT_EQ(headings("[system.pivot]\namplitude_m = 0.1\n[b.pivot]\nphase_deg = 90"),
              "pivot phase 0° | pivot phase 90°");
    EXPECT_EQ(headings("[system.pivot]\namplitude_m = 0.1\n[b.pivot]\namplitude_m = 0"),
              "with pivot motion of direction 90° and amplitude 0.1 m and frequency 1 Hz | no pivot motion");
    EXPECT_EQ(headings("[[system.torque]]\nname = \"t\"\namplitude_N_m = 1\n[[b.torque]]\nname = \"t\"\njoint = 2"),
              "torque \"t\" joint 1 | torque \"t\" joint 2");
    EXPECT_EQ(headings("[system]\nmodel = \"constraints\"\nstabilise = \"baumgarte\"\n[b]\nstabilise_rate_per_s = 20"),
              "stabilise rate 10 1/s | stabilise rate 20 1/s");
    EXPECT_EQ(headings("[system]\nmodel = \"constraints\"\nstabilise = \"baumgarte\"\n[b]\nstabilise = \"none\""),
              "stabilisation baumgarte, stabilise rate 10 1/s | stabilisation none");
    EXPECT_EQ(headings("[system]\nlinks = 5\njoint_viscous_N_m_s = 0.1\n[b]\njoint_viscous_N_m_s = 0.2"),
              "viscous friction 0.1 N m s | viscous friction 0.2 N m s");
    EXPECT_EQ(headings("[scene]\nduration_s = 1\n[system]\naccuracy = 1e-3\n[b]\nprecision = \"quad\""),
              "in double | in quad");
    EXPECT_EQ(headings("[system]\nlinks = 5\n[b]\njoint_viscous_N_m_s = [0, 0, 0, 0, 0.1]"),
              "no viscous friction | viscous friction of link 5 0.1 N m s");
    EXPECT_EQ(headings("[system]\nlinks = 1\nrod_mass_kg = 0.3\n[b]\ncenter_m = 0.5\ninertia_kg_m2 = 0.02"),
              "centre of mass at the end, point mass | centre of mass 0.5 m, inertia 0.02 kg m²");
    EXPECT_EQ(headings(""), "a | b, the same");
}

TEST(Captions, InPlainWordsHaveNoSymbols) {
    const auto scene = scene_of("pendulum-portrait", {"scene.duration_s=2"});
    const auto said = side_captions(scene, Wording::plain);
    EXPECT_EQ(said[0].heading, "135°");
    EXPECT_EQ(said[1].heading, "135.0001°");
    EXPECT_EQ(said[1].note, "");
    EXPECT_EQ(scene_caption(scene, Wording::plain), "two double pendulums, released at rest");
}

TEST(Defaults, AreThoseOfTheReference) {
    const auto chain = preset_from("[system]\nlinks = 3\nmodel = \"constraints\"\nstabilise = \"baumgarte\"").a;
    EXPECT_EQ(chain.stabilise_rate_per_s, 10);
    EXPECT_EQ(chain.mass_kg, (std::vector<Quad>{1, 1, 1}));
    EXPECT_EQ(chain.length_m, (std::vector<Quad>{1, 1, 1}));
    EXPECT_EQ(preset_from("[video]\nlayout = \"ensemble\"").video.members.count, 100);
    const auto none = preset_from("").a;
    EXPECT_EQ(none.mass_kg, (std::vector<Quad>{1, 1}));
    EXPECT_EQ(none.length_m, (std::vector<Quad>{1, 1}));
    EXPECT_EQ(none.angle_deg, (std::vector<Quad>{90, 90}));
    EXPECT_EQ(none.omega_deg_per_s, (std::vector<Quad>{0, 0}));
}

TEST(Defaults, OfADropletAndOfTransparency) {
    const auto droplet = preset_from("[[system.force]]\nkind = \"droplet\"\nposition_m = [3, 0]").a.forces.at(0);
    EXPECT_EQ(droplet.mass_kg, 1);
    EXPECT_TRUE(preset_from("[video]\nformat = \"webm\"\ntransparent = true").video.transparent);
    refusal([] { preset_from("[video]\nformat = \"webm\"\ntransparent = true\npixel_format = \"yuv444p\""); });
    EXPECT_EQ(preset_from("[video]\nlayout = \"ensemble\"\nmembers = 1000").video.members.count, 1000);
    EXPECT_EQ(preset_from("[video]\nlayout = \"ensemble\"\nmembers = 2").video.members.count, 2);
    EXPECT_EQ(preset_from("[video]\ncontact_sheet = [32, 1]").video.contact_sheet, (std::array{32, 1}));
}

TEST(Resolved, HasARateOfStabilisingWhereThereIsOne) {
    const auto resolved = [](const std::string& stabilise) {
        return resolved_toml(preset_from("[system]\nmodel = \"constraints\"\nstabilise = \"" + stabilise + "\""));
    };
    EXPECT_TRUE(says(resolved("baumgarte"), "\nstabilise_rate_per_s = 10\n"));
    EXPECT_EQ(resolved("projection").find("stabilise_rate_per_s"), std::string::npos);
}

TEST(Resolved, KeepsTheRangeOfEveryStripAndTheColoursOfTheSides) {
    const std::string panels =
        "panels = [\"pendulums\", \"distance\", \"exponent\", \"energy\", \"rod-error\", \"rod-force\"]\n";
    for (const std::string range : {"distance_range = [0.001, 0.01]", "exponent_range = [-1, 2]",
                                    "energy_range = [1e-05, 1]", "rod_error_range = [1e-09, 1e-08]",
                                    "rod_force_range = [-3, 30]", "side_colors = [\"#102030\", \"#a0b0c0\"]"}) {
        EXPECT_TRUE(says(resolved_toml(preset_from("[video]\n" + panels + range)), "\n" + range + "\n"));
    }
}

TEST(Words, OfLongValuesInErrorsAreShortened) {
    const auto error = [](std::size_t letters) {
        return refusal([&] { preset_from("[system]\nlinks = \"" + std::string(letters, 'y') + "\""); });
    };
    // 60 characters with the quotes
    EXPECT_TRUE(error(58).ends_with("it is a string (\"" + std::string(58, 'y') + "\")")) << error(58);
    EXPECT_TRUE(error(59).ends_with("it is a string (\"" + std::string(58, 'y') + "…)")) << error(59);
}

}  // namespace doppel::captions_test

#include "base/text.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace preset_errors_test {

struct Case {
    const char* text;     // of presets/x.toml
    const char* message;  // all of it
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.message;
}

std::string message_of(const char* text) {
    const auto [code, message] = error_of([&] { read_preset({"x", "presets/x.toml", text}); });
    EXPECT_EQ(code, ExitCode::bad_input) << text;
    return message;
}

class PresetErrors : public testing::TestWithParam<Case> {};

TEST_P(PresetErrors, NamePlaceValueAndRemedy) {
    EXPECT_EQ(message_of(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Keys, PresetErrors,
    testing::Values(Case{"[system]\nlenght_m = [1, 1]",
                         R"(presets/x.toml:2:1: [system] has no "lenght_m"; did you mean "length_m"?)"},
                    Case{"titel = \"x\"", R"(presets/x.toml:1:1: a preset has no "titel"; did you mean "title"?)"},
                    Case{"[vidoe]\nfps = 3", R"(presets/x.toml:1:2: a preset has no "vidoe"; did you mean "video"?)"},
                    Case{"[scene]\nzzzzzzzz = 1",
                         R"(presets/x.toml:2:1: [scene] has no "zzzzzzzz"; it has duration_s, kind, sample_hz)"},
                    Case{"scene = 3", "presets/x.toml:1:1: scene must be a table; it is a whole number (3)"},
                    Case{"[scene", "presets/x.toml:1:7: Error while parsing table header: encountered end-of-file"}));

INSTANTIATE_TEST_SUITE_P(
    System, PresetErrors,
    testing::Values(
        Case{"[b]\n\nmass_kg = [1, -1]", "presets/x.toml:3:1: [b] mass_kg[1] must be > 0; it is -1"},
        Case{"[system]\nlength_m = [0, 1]", "presets/x.toml:2:1: [system] length_m[0] must be > 0; it is 0"},
        Case{"[a]\nangle_deg = [1, nan]", "presets/x.toml:2:1: [a] angle_deg[1] must be finite; it is nan"},
        Case{"[system]\nomega_deg_per_s = [inf, 0]",
             "presets/x.toml:2:1: [system] omega_deg_per_s[0] must be finite; it is inf"},
        Case{"[system]\nangle_deg = [1, 2, 3]",
             "presets/x.toml:2:1: [system] angle_deg must have 2 numbers, one a link; it has 3: [1, 2, 3]"},
        Case{"[system]\nangle_deg = \"90\"",
             "presets/x.toml:2:1: [system] angle_deg must be a number, or an array of 2 numbers, one a link; it is a "
             "string (\"90\")"},
        Case{"[system]\nangle_deg = [90, \"90\"]",
             "presets/x.toml:2:1: [system] angle_deg[1] must be a number; it is a string (\"90\")"},
        Case{"[system]\ngravity_m_per_s2 = 0", "presets/x.toml:2:1: [system] gravity_m_per_s2 must be > 0; it is 0"},
        Case{"[system]\ngravity_m_per_s2 = true",
             "presets/x.toml:2:1: [system] gravity_m_per_s2 must be a number; it is a boolean (true)"},
        Case{
            "[b]\nlinks = 3",
            "presets/x.toml:2:1: [b] links must be that of the other side, so that the two can be compared; they are 2 "
            "and 3"},
        Case{"[system]\nlinks = 2.0",
             "presets/x.toml:2:1: [system] links must be a whole number; it is a decimal number (2)"},
        Case{"[system]\nlinks = 0", "presets/x.toml:2:1: [system] links must be from 1 to 10000; it is 0"},
        Case{
            "[system]\nmodel = \"angels\"",
            R"(presets/x.toml:2:1: [system] model must be "auto", "angles", "constraints" or "mechanism"; it is "angels"; did you mean "angles"?)"},
        Case{
            "[system]\nintegrator = \"magic\"",
            R"(presets/x.toml:2:1: [system] integrator must be "euler", "semi-implicit-euler", "midpoint", "rk4", "dopri5", "dop853", "adams", "gauss4", "gauss6", "taylor", "rattle" or "rattle6"; it is "magic")"},
        Case{"[system]\nintegrator = 4",
             "presets/x.toml:2:1: [system] integrator must be a string; it is a whole number (4)"},
        Case{"[system]\nprecision = \"half\"",
             R"(presets/x.toml:2:1: [system] precision must be "double" or "quad"; it is "half")"},
        Case{"[system]\nintegrator = \"taylor\"\nstep_s = 0.1",
             R"(presets/x.toml:3:1: [system] step_s is for methods with a fixed step; "taylor" goes by tolerance)"},
        Case{"[system]\nintegrator = \"dop853\"\ntolerance = 0",
             "presets/x.toml:3:1: [system] tolerance must be > 0; it is 0"},
        Case{
            "[system]\nmodel = \"angles\"\nintegrator = \"rattle\"",
            R"(presets/x.toml:3:1: [system] integrator "rattle" serves constraints and mechanism, not model = "angles")"},
        Case{"[system]\nmodel = \"constraints\"\nintegrator = \"gauss6\"",
             R"(presets/x.toml:3:1: [system] integrator "gauss6" serves angles, not model = "constraints")"},
        Case{"[system]\nstabilise = \"baumgarte\"\nmodel = \"angles\"",
             "presets/x.toml:2:1: [system] stabilise is for constraints; in angles the rods keep their length by "
             "themselves"},
        Case{"[system]\nstabilise = \"projection\"\nintegrator = \"rattle6\"",
             R"(presets/x.toml:2:1: [system] stabilise is not for "rattle6", which keeps the constraints itself)"},
        Case{"[system]\nstabilise = \"tape\"",
             R"(presets/x.toml:2:1: [system] stabilise must be "none", "baumgarte" or "projection"; it is "tape")"},
        Case{"[system]\ntolerance = 1e-9",
             R"(presets/x.toml:2:1: [system] tolerance is for adaptive methods; "euler" goes by step_s)"},
        Case{"[system]\nstep_s = \"fast\"",
             "presets/x.toml:2:1: [system] step_s must be a number or a fraction such as \"1/30000\"; it is \"fast\""},
        Case{"[system]\nstep_s = -0.1", "presets/x.toml:2:1: [system] step_s must be > 0; it is -0.1"},
        Case{"[system]\nstep_s = 1e-300",
             "presets/x.toml:2:1: [system] step_s has more digits than Doppel counts with; it is 1e-300"}));

INSTANTIATE_TEST_SUITE_P(
    Rates, PresetErrors,
    testing::Values(
        Case{"[scene]\nsample_hz = 7",
             "presets/x.toml:2:1: [scene] sample_hz must divide the step rate, 30000 Hz on side a; it is 7; 6 or 8 "
             "would do"},
        Case{"[b]\nstep_s = \"1/100\"",
             "presets/x.toml: [scene] sample_hz must divide the step rate, 100 Hz on side b; it is 120; 100 would do"},
        Case{"[scene]\nduration_s = 0", "presets/x.toml:2:1: [scene] duration_s must be > 0; it is 0"},
        Case{"[scene]\nduration_s = 0.01",
             "presets/x.toml:2:1: [scene] duration_s must be a whole number of samples at 120 Hz; 1/100 s are 6/5"},
        Case{"[scene]\nduration_s = 1e12",
             "presets/x.toml:2:1: [scene] duration_s must be at most 100000000 samples; it is 120000000000000"},
        Case{
            "[scene]\nkind = \"trio\"",
            R"(presets/x.toml:2:1: [scene] kind must be "pair", "sweep", "curves", "convergence", "spectrum", "section", "flip-map", "links", "work-precision", "stability", "drift" or "audit"; it is "trio")"},
        Case{"[video]\nfps = 50",
             "presets/x.toml:2:1: [video] fps must divide sample_hz · speed = 120, so that each frame is a sample; it "
             "is 50"},
        Case{"[scene]\nduration_s = 0.025\n[video]\nfps = 60",
             "presets/x.toml:4:1: [video] fps must let the last of 3 samples be a frame; with 60 one sample in 2 is "
             "one"},
        Case{"[video]\nspeed = 30",
             "presets/x.toml: [video] fps must be at most 1000 and a fraction of whole numbers up to 1000000; it is "
             "3600"}));

INSTANTIATE_TEST_SUITE_P(
    Video, PresetErrors,
    testing::Values(
        Case{"[video]\nsize = [641, 360]",
             "presets/x.toml:2:1: [video] size must be even, as H.264 needs it in yuv420p; it is [641, 360]; [642, "
             "360] would do"},
        Case{"[video]\nsize = [0, 100]",
             "presets/x.toml:2:1: [video] size must be whole numbers from 64 to 16384; it is [0, 100]"},
        Case{"[video]\nformat = \"avi\"",
             R"(presets/x.toml:2:1: [video] format must be "mp4", "webm", "gif", "apng" or "png"; it is "avi")"},
        Case{"[video]\ncrf = 60", "presets/x.toml:2:1: [video] crf must be from 0 to 51; it is 60"},
        Case{
            "[video]\ntheme = \"drak\"",
            R"(presets/x.toml:2:1: [video] theme must be "dark", "light" or "high-contrast"; it is "drak"; did you mean "dark"?)"},
        Case{
            "[video]\npreset = \"quick\"",
            R"(presets/x.toml:2:1: [video] preset must be "ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower" or "veryslow"; it is "quick")"},
        Case{"[video]\nside_colors = [\"red\", \"#0000ff\"]",
             R"(presets/x.toml:2:1: [video] side_colors must be colours such as "#ff9f40"; [0] is "red")"},
        Case{"[video]\nside_colors = [\"#0000ff\"]",
             "presets/x.toml:2:1: [video] side_colors must have 2 colours, a and b; it has 1"},
        Case{"[video]\nside_colors = [1, 2]",
             "presets/x.toml:2:1: [video] side_colors must be an array of strings; 1 is a whole number"},
        Case{
            "[video]\npanels = []",
            R"(presets/x.toml:2:1: [video] panels must hold at least one of "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force")"},
        Case{
            "[video]\npanels = [\"phase\"]",
            R"(presets/x.toml:2:1: [video] panels may hold "pendulums", "distance", "exponent", "energy", "rod-error", "rod-force"; "phase" is none of them)"},
        Case{"[video]\npanels = \"energy\"",
             "presets/x.toml:2:1: [video] panels must be an array of strings; it is a string (\"energy\")"},
        Case{"[video]\ntrail_s = -1", "presets/x.toml:2:1: [video] trail_s must be from 0 (none) to 3600; it is -1"},
        Case{"[video]\ndistance_range = [1, 2]",
             "presets/x.toml:2:1: [video] distance_range must rise by 1 to 60 powers of ten; it is [1, 2]"}));

/// Letters beyond ASCII are escaped.
TEST(PresetErrors, AreShortAndUtf8WhateverTheValue) {
    for (const char* start : {"", "a", "ab", "abc"}) {
        std::string text(start);
        for (int i = 0; i < 40; ++i) text += "é";
        const auto message = message_of(("[scene]\nduration_s = \"" + text + "\"").c_str());
        EXPECT_TRUE(is_utf8(message)) << message;
        EXPECT_TRUE(message.ends_with("…")) << message;
        EXPECT_LT(message.size(), 160u);
    }
}

TEST(Overrides, NameTheOptionInPlaceOfALine) {
    const auto fault = [](const std::vector<std::string>& arguments) {
        const auto [code, message] = error_of([&] { scene_of("butterfly", arguments); });
        EXPECT_EQ(code, ExitCode::bad_input);
        return message;
    };
    EXPECT_EQ(fault({"b.mass_kg=[1, -1]"}), "--set b.mass_kg: [b] mass_kg[1] must be > 0; it is -1");
    EXPECT_EQ(fault({"system.lenght_m=[1, 1]"}),
              R"(--set system.lenght_m: [system] has no "lenght_m"; did you mean "length_m"?)");
    EXPECT_EQ(fault({"nonsense"}), R"(--set wants table.key=VALUE; it is "nonsense")");
    EXPECT_EQ(fault({"video.crf=1", "video.crf=2"}), "video.crf is given twice: --set video.crf and --set video.crf");
    EXPECT_EQ(fault({"foo.bar=3"}),
              R"(--set foo.bar: a preset has no "foo"; it has a, b, scene, system, title, video)");
    EXPECT_EQ(fault({"video.foo.bar=3"}).rfind(R"(--set video.foo.bar: [video] has no "foo"; )", 0), 0u);
    EXPECT_EQ(fault({"system.links=3", "system={}"}),
              "--set system: would drop --set system.links, which was given before it; give the table first");
    EXPECT_EQ(fault({"title.x=1"}), R"(--set title.x: "title" is no table)");
    EXPECT_NE(fault({"video.theme=dark"}).find("strings want quotes: 'video.theme=\"dark\"'"), std::string::npos);
    EXPECT_EQ(fault({"video.crf=1\nx=2"}), "--set video.crf: \"1\nx=2\" is more than one value");
}

TEST(Overrides, OfAWholeTableComesBeforeThoseOfItsKeys) {
    const auto scene = scene_of("butterfly", {"b={}", "system={}", "system.links=3", "b.angle_deg=[1, 2, 3]"});
    EXPECT_EQ(scene.preset.a.links(), 3u);
    EXPECT_EQ(scene.preset.b.angle_deg, (std::vector<Quad>{1, 2, 3}));
}

TEST(Overrides, GoOnTopOfThePreset) {
    const auto scene =
        scene_of("butterfly", {"system.integrator=\"rk4\"", "b.angle_deg=[80, 70]", "scene.duration_s=2"});
    EXPECT_EQ(scene.a.method.name, "rk4");
    EXPECT_EQ(scene.preset.b.angle_deg, (std::vector<Quad>{80, 70}));
    EXPECT_EQ(scene.preset.a.angle_deg, (std::vector<Quad>{90, 90}));
    EXPECT_EQ(scene.samples, 240);
}

TEST(FindPreset, AFigureOrAFilmIsAdvisedByWhatFindsIt) {
    const auto message = [](const PresetText& source) { return error_of([&] { read_preset(source); }).second; };
    EXPECT_EQ(message(find_preset("fig6")),
              "presets/figures/fig6.toml: this is a figure, not a film; draw it with: doppel figure fig6");
    const auto path = std::string(DOPPEL_SOURCE_DIR) + "/presets/figures/fig6.toml";
    EXPECT_EQ(message(find_preset(path)), path + ": this is a figure, not a film; draw it with: doppel figure " + path);
}

TEST(FindPreset, NamesTheNearestOrWhatIsInItsPlace) {
    EXPECT_EQ(error_of([] { find_preset("buterfly"); }).second,
              R"(there is no preset "buterfly"; did you mean "butterfly"?)");
    EXPECT_EQ(error_of([] { find_preset("x/y.toml"); }).second, "x/y.toml: there is no such preset");
    EXPECT_EQ(error_of([] { find_preset("/"); }).second, "/ is a folder; a preset is a TOML file");
    EXPECT_NE(error_of([] { find_preset("qqqqqqqqqq"); }).second.find("there are audit, butterfly"), std::string::npos);
}

}  // namespace preset_errors_test
}  // namespace doppel

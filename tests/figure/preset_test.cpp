#include "figure/preset.hpp"

#include "figure/part_file.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel {
namespace preset_test {

std::vector<PresetText> builtin_figures() {
    std::vector<PresetText> figures;
    for (const auto& preset : builtin_presets())
        if (is_figure(preset)) figures.push_back(preset);
    return figures;
}

TEST(FigurePreset, EveryBuiltInOneReadsAndHasATitle) {
    std::set<std::string> names;
    for (const auto& preset : builtin_figures()) {
        const auto figure = read_figure(preset);
        EXPECT_EQ(figure.name, preset.name);
        EXPECT_NE(figure.title, preset.name) << preset.path;
        EXPECT_GT(figure.experiment->trials(), 0u);
        EXPECT_GE(figure.experiment->together(), 1u);
        names.insert(preset.name);
    }
    for (const char* name :
         {"fig2-left", "fig2-right", "fig3-left", "fig3-right", "fig4-left", "fig4-right", "fig5-left", "fig5-right",
          "fig6", "fig7", "fig8", "why-they-part", "droplet", "lyapunov-spectrum", "poincare", "flip-map", "links"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(FigurePreset, DrawsOnlyLettersThatTheFontHas) {
    const std::string scene = "\n[scene]\nkind = \"curves\"\n[[curve]]\ncolumn = \"one\"\n";
    const auto refusal = [](const std::string& text) { return error_of([&] { figure_from(text); }).second; };
    const std::string lacks = " holds \"双\" (U+53CC), which the built-in font lacks; ";
    for (const std::string key : {"title", "subtitle", "erratum"}) {
        const auto message = refusal(key + " = \"双\"" + scene);
        EXPECT_EQ(message.rfind("presets/x.toml:1:1: " + key + lacks, 0), 0u) << message;
    }
    EXPECT_EQ(refusal("captions = [\"a\", \"双\"]" + scene).rfind("presets/x.toml:1:1: captions" + lacks, 0), 0u);
    EXPECT_EQ(refusal(scene + "label = \"双\"").rfind("presets/x.toml:6:1: [[curve]] 1 label" + lacks, 0), 0u);
    EXPECT_EQ(refusal(scene), "nothing was thrown");
}

TEST(FigurePreset, OfTheStudyStatesItsErratum) {
    for (const auto& preset : builtin_figures())
        if (preset.name.starts_with("fig")) {
            EXPECT_FALSE(read_figure(preset).erratum.empty()) << preset.name;
        }
}

TEST(FigurePreset, ResolvedReadsBackToTheSame) {
    for (const auto& preset : builtin_figures()) {
        const auto figure = read_figure(preset, sets({"chart.theme=\"dark\"", "chart.scale=1.5"}));
        const auto again = read_figure({preset.name, preset.name + ".resolved", figure.resolved()});
        EXPECT_EQ(again.resolved(), figure.resolved()) << preset.name;
        EXPECT_EQ(header_of(again), header_of(figure)) << preset.name;
        EXPECT_EQ(again.experiment->columns(), figure.experiment->columns()) << preset.name;
        EXPECT_EQ(again.picture_size(), figure.picture_size()) << preset.name;
        EXPECT_EQ(again.title, figure.title);
        EXPECT_EQ(again.subtitle, figure.subtitle);
        EXPECT_EQ(again.captions, figure.captions);
        EXPECT_EQ(again.erratum, figure.erratum);
    }
}

TEST(FigurePreset, ResolvedKeepsEveryDigitAndCharacter) {
    const auto figure = figure_from(
        "title = \"a \\\"b\\\" \\\\ ½ ü\"\ncaptions = [\"x, y\", \"\"]\n[scene]\nkind = \"sweep\"\n[sweep]\n"
        "from = 0.1234567890123456789012345678901\nto = 0.1234567890123456789012345678901\ndifference = 0.003\n");
    const auto again = read_figure({"x", "again", figure.resolved()});
    EXPECT_EQ(again.title, "a \"b\" \\ ½ ü");  // of others: PresetText.EveryCharacterComesBackFromTheResolvedPreset
    EXPECT_EQ(again.captions, (std::vector<std::string>{"x, y", ""}));
    EXPECT_NE(again.resolved_work().find("0.1234567890123456789012345678901"), std::string::npos)
        << again.resolved_work();
    EXPECT_EQ(again.resolved(), figure.resolved());
}

TEST(FigurePreset, ScaleIsOfThePicture) {
    EXPECT_EQ(figure_of("fig6").picture_size(), (Size{1600, 900}));
    EXPECT_EQ(figure_of("fig6", {"chart.scale=2", "chart.size=[480, 270]"}).picture_size(), (Size{960, 540}));
}

TEST(FigurePreset, IsNoFilm) {
    const auto film = error_of([] { read_figure(find_preset("butterfly")); });
    EXPECT_EQ(film.first, ExitCode::bad_input);
    EXPECT_NE(film.second.find("doppel render butterfly"), std::string::npos) << film.second;
    const auto figure = error_of([] { read_preset(find_preset("fig2-right")); });
    EXPECT_EQ(figure.first, ExitCode::bad_input);
    EXPECT_NE(figure.second.find("doppel figure fig2-right"), std::string::npos) << figure.second;
}

TEST(FigurePreset, IsCalledAsItWasGiven) {
    // a preset of one's own is no name that doppel knows
    const auto film = error_of([] { read_figure({"base", "base.toml", "", "base.toml"}); });
    EXPECT_NE(film.second.find("doppel render base.toml"), std::string::npos) << film.second;
    const auto figure = error_of([] { read_preset({"x", "my/x.toml", "[scene]\nkind = \"audit\"", "my/x.toml"}); });
    EXPECT_NE(figure.second.find("doppel figure my/x.toml"), std::string::npos) << figure.second;
}

std::string subtitle_of(const std::string& preset, const std::vector<std::string>& arguments = {}) {
    return figure_of(preset, arguments).subtitle;
}

TEST(FigurePreset, OfASweepSaysWhatItIs) {
    for (const auto& [name, words] : std::vector<std::pair<const char*, const char*>>{
             {"fig2-right", "two links in angles, θ₂ = 0, twins 0.003° apart; explicit Euler, 1/30 000 s"},
             {"fig3-left", "two links in angles, θ₂ = 0, m₁ = 1 kg against m₁ = 1.01 kg; explicit Euler, 1/30 000 s"},
             {"fig3-right",
              "two links in angles, 90°/90°, mass ratios m₁/m₂ apart by 0.01; explicit Euler, 1/30 000 s"},
             {"fig4-right", "two particles on rods, θ₂ = 0, twins 0.003° apart; explicit Euler, 1/30 000 s"},
             {"fig5-left", "two particles on rods, θ₂ = 0, m₁ = 1 kg against m₁ = 1.01 kg; explicit Euler, 1/30 000 s"},
             {"fig5-right",
              "two particles on rods, 90°/90°, mass ratios m₁/m₂ apart by 0.01; explicit Euler, 1/30 000 s"},
             {"fig8", "three particles on rods, θ₂ = θ₃ = 0, twins 0.003° apart; explicit Euler, 1/30 000 s"}})
        EXPECT_EQ(subtitle_of(name), words) << name;
}

TEST(FigurePreset, OfASweepSaysWhatWasSet) {
    for (const auto& [set, words] : std::vector<std::pair<std::string, std::string>>{
             {"sweep.difference=0.25", "two links in angles, θ₂ = 0, twins 0.25° apart; explicit"},
             {"sweep.difference=-0.25", ", twins 0.25° apart; explicit"},
             {"sweep.difference=0", "two links in angles, θ₂ = 0; explicit Euler, 1/30 000 s"},
             {"system.angle_deg=[0, 30.5]", "two links in angles, θ₂ = 30.5°, twins"},
             {"system.omega_deg_per_s=[0, 5]", ", θ₂ = 0, ω = 0/5 °/s, twins"},
             {"system.integrator=\"rk4\"", "; "},
             {"system.step_s=\"1/1200\"", "; explicit Euler, 1/1 200 s"},
             {"system.precision=\"quad\"", "; explicit Euler, 1/30 000 s, in quad"},
             {"b.model=\"constraints\"", "two links, θ₂ = 0, twins 0.003° apart, angles against constraints; explicit"},
             {"b.length_m=[1, 2]", ", l₂ = 1 m against l₂ = 2 m; explicit"},
             {"b.integrator=\"rk4\"", "twins 0.003° apart, explicit Euler against "},
             {"sweep.parameter=\"theta2_deg\"", "two links in angles, θ₁ = 0, twins 0.003° apart"},
             {"subtitle=\"mine\"", "mine"}})
        EXPECT_NE(subtitle_of("fig2-right", {set}).find(words), std::string::npos)
            << set << ": " << subtitle_of("fig2-right", {set});
    EXPECT_EQ(subtitle_of("fig2-right", {"subtitle=\"\""}), "");
    EXPECT_EQ(subtitle_of("fig2-right", {"system.integrator=\"rk4\""}).find("Euler"), std::string::npos);
    EXPECT_NE(subtitle_of("fig8", {"system.angle_deg=[0, 10, 20]"}).find("θ₂ = 10°, θ₃ = 20°"), std::string::npos);
    EXPECT_NE(subtitle_of("fig3-right", {"system.angle_deg=[90, 45]"}).find("90°/45°"), std::string::npos);
}

TEST(FigurePreset, OfALogarithmOfRatiosTakesADistance) {
    const auto [code, message] = error_of([] { figure_of("fig2-left", {"b.angle_deg=[90, 90]"}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_NE(message.find("[curves] quantity \"log_ratio\" takes sides that are released differently"),
              std::string::npos)
        << message;
}

struct Case {
    std::string kind;   // of [scene]
    std::string text;   // what follows, from line 3 on
    std::string place;  // what the message begins with after the path
    std::vector<std::string> words;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.kind << ": " << c.text;
}

class FigureErrors : public testing::TestWithParam<Case> {};

/// "path:line:column: [table] key" and the rest.
TEST_P(FigureErrors, NamePlaceValueAndRemedy) {
    const auto& c = GetParam();
    const auto [code, message] = error_of([&] { figure_from("[scene]\nkind = \"" + c.kind + "\"\n" + c.text); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_EQ(message.rfind("presets/x.toml" + c.place, 0), 0u) << message;
    for (const auto& words : c.words) EXPECT_NE(message.find(words), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Sweep, FigureErrors,
    testing::Values(
        Case{"sweep", "[sweep]\nstep = 0", ":4:1: [sweep] step", {"must be > 0; it is 0"}},
        Case{"sweep", "[sweep]\nstep = -0.5", ":4:1: [sweep] step", {"must be > 0; it is -0.5"}},
        Case{"sweep", "[sweep]\nfrom = 10\nto = 5", ":5:1: [sweep] to", {"it is 5"}},
        Case{"sweep", "[sweep]\nto = 1e12", ":4:1: [sweep] to", {"it is 1000000000000"}},
        Case{"sweep", "[sweep]\nparameter = \"theta1\"", ":4:1: [sweep] parameter", {"theta1_deg", "it is \"theta1\""}},
        Case{"sweep", "[sweep]\nfrm = 1", ":4:1: [sweep] has no \"frm\"", {"did you mean \"from\"?"}},
        Case{"sweep", "[sweep]\nfrom = \"1\"", ":4:1: [sweep] from", {"must be a number; it is a string (\"1\")"}},
        Case{"sweep", "[sweep]\nfrom = nan", ":4:1: [sweep] from", {"must be finite; it is nan"}},
        Case{"sweep", "[sweep]\nto = inf", ":4:1: [sweep] to", {"must be finite; it is inf"}},
        Case{"sweep", "[sweep]\nexponent = 1", ":4:1: [sweep] exponent", {"must be true or false"}},
        Case{"sweep",
             "[sweep]\nexponent = true\nexponent_duration_s = -5",
             ":5:1: [sweep] exponent_duration_s",
             {"must be > 0"}},
        Case{"sweep",
             "[system]\nlinks = 1\n[sweep]\nparameter = \"mass_ratio\"",
             ":6:1: [sweep] parameter",
             {"2 links"}},
        Case{"sweep", "[system]\nlenght_m = 3", ":4:1: [system] has no \"lenght_m\"", {"did you mean \"length_m\"?"}},
        Case{"sweep", "[curves]\nquantity = \"distance\"", ":3:2: a preset has no \"curves\"", {}},
        Case{"sweep", "[video]\nfps = 60", ":3:2: a preset has no \"video\"", {}},
        Case{"sweep", "sample_hz = 7", ":3:1: [scene] sample_hz", {"must divide the step rate"}}));

INSTANTIATE_TEST_SUITE_P(
    Values, FigureErrors,
    testing::Values(
        Case{"sweep", "[sweep]\nparameter = \"mass_ratio\"\nfrom = 0\nto = 1", ":5:1: [sweep] from", {"> 0"}},
        Case{"sweep", "[sweep]\nparameter = \"length_ratio\"\nfrom = -1\nto = 1", ":5:1: [sweep] from", {"> 0"}},
        Case{"sweep", "[sweep]\nto = 1\nstep = 0.4", "", {"[sweep]", "step"}},
        Case{"convergence", "[convergence]\nmethods = []", ":4:1: [convergence] methods", {}},
        Case{"curves", "[[curve]]\ncolumn = \"x\"\n[[curve]]\ncolumn = \"x\"", ":6:1: [[curve]] 2 column", {"\"x\""}},
        Case{"curves", "[[curve]]\ncolumn = \"time_s\"", ":4:1: [[curve]] 1 column", {"\"time_s\""}},
        Case{"sweep",
             "[[system.force]]\nkind = \"spring\"\nfrom = \"bob1\"\nto = [1, 0]\n[sweep]\nexponent = true",
             ":8:1: [sweep] exponent",
             {}},
        Case{"section", "[system]\nangle_deg = [3, 3]", ":4:1: [system]", {"angle_deg"}}));

INSTANTIATE_TEST_SUITE_P(
    Chart, FigureErrors,
    testing::Values(Case{"sweep", "[chart]\nsize = [0, 3]", ":4:1: [chart] size", {"it is [0, 3]"}},
                    Case{"sweep", "[chart]\nscale = 9", ":4:1: [chart] scale", {"at most 8; it is 9"}},
                    Case{"sweep", "[chart]\nscale = 0", ":4:1: [chart] scale", {"must be > 0; it is 0"}},
                    Case{"sweep",
                         "[chart]\ntheme = \"blue\"",
                         ":4:1: [chart] theme",
                         {"\"dark\", \"light\" or \"high-contrast\"; it is \"blue\""}},
                    Case{"sweep", "[chart]\nfps = 3", ":4:1: [chart] has no \"fps\"", {}}));

INSTANTIATE_TEST_SUITE_P(
    Curves, FigureErrors,
    testing::Values(
        Case{"curves", "[curves]\nquantity = \"dist\"", ":4:1: [curves] quantity", {"\"distance\" or \"log_ratio\""}},
        Case{"curves", "[[curve]]\nlabel = \"x\"", "", {"[[curve]] 1 column is missing"}},
        Case{"curves", "[[curve]]\ncolumn = \"x\"\ncolour = 3", ":5:1: [[curve]] 1 has no \"colour\"", {}},
        Case{"curves", "[[curve]]\ncolumn = \"x\"\nsystem.angle = [3, 3]", ":5:8: ", {"has no \"angle\""}},
        Case{"curves", "[curves]\ncheck_tolerance = 1e-9", ":4:1: [curves] check_tolerance", {"a tolerance"}},
        Case{"curves", "[curve]\ncolumn = \"x\"", ":3:2: curve", {"[[curve]]"}}));

INSTANTIATE_TEST_SUITE_P(
    Others, FigureErrors,
    testing::Values(
        Case{"sweep",
             "[chart]\nscale = 0.001",
             ":4:1: [chart] scale",
             {"16 to 16384 px a side; 0.001 times 1600×900 px"}},
        Case{"sweep", "[chart]\nscale = 8\nsize = [4000, 900]", ":4:1: [chart] scale", {"is 32000×7200"}},
        Case{"sweep", "[sweep]\nfrom = 2e6\nto = 2e6", ":4:1: [sweep] from", {"from -1000000 to 1000000°"}},
        Case{"sweep", "[sweep]\ndifference = -1e300", ":4:1: [sweep] difference", {"from -1000000 to 1000000°"}},
        Case{"convergence",
             "[convergence]\nmethods = [\"rk4\", \"rk4\"]",
             ":4:1: [convergence] methods",
             {"must differ"}},
        Case{"drift", "[drift]\nmethods = [\"rk4\", \"rk4\"]", ":4:1: [drift] methods", {"must differ; \"rk4\""}},
        Case{"drift", "[drift]\nprojected = [\"rk4\", \"rk4\"]", ":4:1: [drift] projected", {"must differ"}},
        Case{"work-precision",
             "[work_precision]\nmethods = [\"rk4\", \"rk4\"]",
             ":4:1: [work_precision] methods",
             {"must differ"}},
        Case{"convergence", "[convergence]\nmethods = [\"magic\"]", ":4:1: [convergence] methods", {"\"magic\""}},
        Case{"convergence",
             "[convergence]\nmethods = [\"euler/dop853\"]",
             ":4:1: [convergence] methods",
             {"\"euler/dop853\""}},
        Case{"convergence", "[convergence]\nhalvings = 0", ":4:1: [convergence] halvings", {"it is 0"}},
        Case{"convergence", "[convergence]\nhalvings = 2.5", ":4:1: [convergence] halvings", {"a whole number"}},
        Case{"spectrum", "[system]\nintegrator = \"rk4\"", ":4:1: [system] has no \"integrator\"", {}},
        Case{"spectrum", "[system]\nmodel = \"angles\"", ":4:1: [system] has no \"model\"", {}},
        Case{"spectrum", "[system]\nlinks = 5", "", {"1 to 4 links; there are 5"}},
        Case{"spectrum", "[spectrum]\nsamples = 1", ":4:1: [spectrum] samples", {"it is 1"}},
        Case{"spectrum", "[spectrum]\nduration_s = 0", ":4:1: [spectrum] duration_s", {"must be > 0"}},
        Case{"spectrum", "duration_s = 3", ":3:1: [scene] has no \"duration_s\"", {}},
        Case{"spectrum", "[a]\nlinks = 2", ":3:2: a preset has no \"a\"", {}},
        Case{"section", "[section]\nenergy_J = []", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
        Case{"section", "[section]\nenergy_J = [1, -1]", ":4:1: [section] energy_J[1]", {"must be > 0; it is -1"}},
        Case{"section", "[section]\nenergy_J = [1, 2, 3, 4, 5, 6, 7]", ":4:1: [section] energy_J", {"1 to 6 numbers"}},
        Case{"section", "[system]\nlinks = 3", "", {"two links; there are 3"}},
        Case{"section", "[system]\nprecision = \"quad\"", ":4:1: [system] has no \"precision\"", {}},
        Case{"flip-map", "[system]\nangle_deg = [90, 90]", ":4:1: [system] angle_deg", {"flip map"}},
        Case{"flip-map", "[system]\nlinks = 3", ":4:1: [system] links", {"flip map"}},
        Case{"flip-map", "[system]\nstep_s = 0.1", ":4:1: [system] has no \"step_s\"", {}},
        Case{"flip-map", "[flip_map]\ncolumns = 1", ":4:1: [flip_map] columns", {"from 2 to 20000; it is 1"}},
        Case{"flip-map", "[flip_map]\nduration_s = 0", ":4:1: [flip_map] duration_s", {"must be > 0"}},
        Case{"flip-map", "[flip_map]\nchecked = -1", ":4:1: [flip_map] checked", {"it is -1"}},
        Case{"links", "[system]\nlinks = 2", "", {"one link"}},
        Case{"links", "[system]\nlinks = 1\n[links]\nfrom = 5\nto = 3", ":7:1: [links] to", {"it is 3"}},
        Case{"links", "[system]\nlinks = 1\nintegrator = \"rk4\"", ":5:1: [system] has no \"integrator\"", {}},
        Case{"fractal", "", ":2:1: [scene] kind", {"\"sweep\"", "it is \"fractal\""}}));

TEST(FigureErrors, OfTheTopAreNamed) {
    const std::string scene = "\n[scene]\nkind = \"spectrum\"";
    for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {"captions = \"x\"", "presets/x.toml:1:1: captions must be an array of strings; it is a string (\"x\")"},
             {"captions = [3]", "presets/x.toml:1:1: captions must be an array of strings"},
             {"erratum = 3", "presets/x.toml:1:1: erratum must be a string; it is a whole number (3)"},
             {"subtitel = \"x\"", "presets/x.toml:1:1: a preset has no \"subtitel\"; did you mean \"subtitle\"?"}}) {
        const auto [code, message] = error_of([&] { figure_from(text + scene); });
        EXPECT_EQ(code, ExitCode::bad_input);
        EXPECT_EQ(message.rfind(words, 0), 0u) << message;
    }
    const auto [code, message] = error_of([] { figure_from("curve = 3\n[scene]\nkind = \"curves\""); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_EQ(message.rfind("presets/x.toml:1:1: curve", 0), 0u) << message;
}

TEST(FigureErrors, MethodsThatDoNotServeAreToldAtOnce) {
    const auto [code, message] = error_of([] {
        figure_from(
            "[scene]\nkind = \"convergence\"\n[system]\nmodel = \"angles\"\n[convergence]\nmethods = [\"euler\", "
            "\"rattle\"]");
    });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_NE(message.find("\"rattle\""), std::string::npos) << message;
}

TEST(FigureErrors, OfTheCommandLineNameTheOption) {
    const auto [code, message] = error_of([] { figure_of("fig2-right", {"sweep.step=0"}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_EQ(message, "--set sweep.step: [sweep] step must be > 0; it is 0");
    EXPECT_EQ(error_of([] { figure_of("poincare", {"system.integrator=\"rk4\""}); }).first, ExitCode::bad_input);
}

}  // namespace preset_test
}  // namespace doppel

#include "figure/preset.hpp"

#include "figure/computation.hpp"
#include "figure/refused_figures.hpp"
#include "figure/support.hpp"

#include <gtest/gtest.h>

namespace doppel::preset_test {

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
        names.insert(preset.name);
    }
    for (const char* name : {"fig2-left", "fig2-right", "fig3-left", "fig3-right", "fig4-left", "fig4-right",
                             "fig5-left", "fig5-right", "fig6", "fig7", "fig8", "why-they-part", "droplet",
                             "lyapunov-spectrum", "poincare", "flip-map", "links", "driven-spectrum", "certified"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(FigurePreset, ExponentsAreOfSmoothMotions) {
    const std::string system = "[system]\nlinks = 1\njoint_coulomb_N_m = 0.1\nintegrator = \"rk4\"\n";
    const auto spectrum = error_of([&] {
        figure_from(
            "[scene]\nkind = \"series\"\n[series]\nquantity = \"exponents\"\n[system]\njoint_coulomb_N_m = 0.1\n");
    });
    EXPECT_EQ(spectrum.first, ExitCode::bad_input);
    EXPECT_EQ(spectrum.second.rfind("presets/x.toml:6:1: [system] joint_coulomb_N_m is not for Lyapunov exponents", 0),
              0u)
        << spectrum.second;
    for (const std::string y : {"", "[grid.y]\nkey = \"system.length_m\"\nfrom = 1\nto = 2\npoints = 2\n"}) {
        const auto error =
            error_of([&] { figure_from(system + "[scene]\nkind = \"grid\"\n[grid]\nquantity = \"exponent\"\n" + y); });
        EXPECT_EQ(error.first, ExitCode::bad_input);
        EXPECT_NE(error.second.find("quantity needs a smooth motion"), std::string::npos) << error.second;
    }
    // zero mass
    const auto massless = error_of([&] {
        figure_from(
            "[scene]\nkind = \"series\"\n[series]\nquantity = \"exponents\"\n[system]\nmass_kg = 0\nrod_mass_kg = [1, "
            "0]\n");
    });
    EXPECT_NE(massless.second.find("mass_kg of link 2 and its rod_mass_kg are both 0"), std::string::npos)
        << massless.second;
}

TEST(FigurePreset, DrawsOnlyLettersThatTheFontHas) {
    const std::string scene = "\n[scene]\nkind = \"series\"\n[b]\nangle_deg = 91\n[[curve]]\ncolumn = \"one\"\n";
    const auto refusal = [](const std::string& text) { return error_of([&] { figure_from(text); }).second; };
    const std::string lacks = " contains \"双\" (U+53CC), which the built-in font lacks; ";
    for (const std::string key : {"title", "subtitle", "erratum"}) {
        const auto message = refusal(key + " = \"双\"" + scene);
        EXPECT_EQ(message.rfind("presets/x.toml:1:1: " + key + lacks, 0), 0u) << message;
    }
    EXPECT_EQ(refusal("captions = [\"a\", \"双\"]" + scene).rfind("presets/x.toml:1:1: captions" + lacks, 0), 0u);
    EXPECT_EQ(refusal(scene + "label = \"双\"").rfind("presets/x.toml:8:1: [[curve]] 1 label" + lacks, 0), 0u);
    EXPECT_EQ(refusal(scene), "no error");
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
        EXPECT_EQ(layout_of(again.chart).picture, layout_of(figure.chart).picture) << preset.name;
        EXPECT_EQ(again.title, figure.title);
        EXPECT_EQ(again.subtitle, figure.subtitle);
        EXPECT_EQ(again.captions, figure.captions);
        EXPECT_EQ(again.erratum, figure.erratum);
    }
}

TEST(FigurePreset, ResolvedKeepsEveryDigitAndCharacter) {
    const auto figure = figure_from(
        "title = \"a \\\"b\\\" \\\\ ½ ü\"\ncaptions = [\"x, y\", \"\"]\n[scene]\nkind = \"grid\"\n[grid]\n"
        "difference = 0.003\n[grid.x]\nfrom = 0.1234567890123456789012345678901\n"
        "to = 0.1234567890123456789012345678901\n");
    const auto again = read_figure({"x", "again", figure.resolved()});
    EXPECT_EQ(again.title, "a \"b\" \\ ½ ü");  // of others: PresetText.EveryCharacterComesBackFromTheResolvedPreset
    EXPECT_EQ(again.captions, (std::vector<std::string>{"x, y", ""}));
    EXPECT_NE(again.resolved_work().find("0.1234567890123456789012345678901"), std::string::npos)
        << again.resolved_work();
    EXPECT_EQ(again.resolved(), figure.resolved());
}

TEST(FigurePreset, ScaleIsOfThePicture) {
    EXPECT_EQ(layout_of(figure_of("fig6").chart).picture, (Size{1600, 900}));
    EXPECT_EQ(layout_of(figure_of("fig6", {"chart.scale=2", "chart.size=[480, 270]"}).chart).picture, (Size{960, 540}));
}

TEST(FigurePreset, IsNoFilm) {
    const auto film = error_of([] { read_figure(find_preset("butterfly")); });
    EXPECT_EQ(film.first, ExitCode::bad_input);
    EXPECT_NE(film.second.find("doppel render butterfly"), std::string::npos) << film.second;
    const auto figure = error_of([] { read_preset(find_preset("fig2-right")); });
    EXPECT_EQ(figure.first, ExitCode::bad_input);
    EXPECT_NE(figure.second.find("doppel figure fig2-right"), std::string::npos) << figure.second;
}

TEST(FigurePreset, KeepsTheNameThatWasGiven) {
    // a user's preset is not a built-in name
    const auto film = error_of([] { read_figure({"base", "base.toml", "", "base.toml"}); });
    EXPECT_NE(film.second.find("doppel render base.toml"), std::string::npos) << film.second;
    const auto figure = error_of([] { read_preset({"x", "my/x.toml", "[scene]\nkind = \"grid\"", "my/x.toml"}); });
    EXPECT_NE(figure.second.find("doppel figure my/x.toml"), std::string::npos) << figure.second;
}

std::string subtitle_of(const std::string& preset, const std::vector<std::string>& arguments = {}) {
    return figure_of(preset, arguments).subtitle;
}

TEST(FigurePreset, OfASweepHasADescription) {
    for (const auto& [name, words] : std::vector<std::pair<const char*, const char*>>{
             {"fig2-right", "two links in angles, θ₂ = 0, pair 0.003° apart; explicit Euler, 1/30 000 s"},
             {"fig3-left", "two links in angles, θ₂ = 0, m₁ = 1 kg against m₁ = 1.01 kg; explicit Euler, 1/30 000 s"},
             {"fig3-right",
              "two links in angles, 90°/90°, mass ratios m₁/m₂ apart by 0.01; explicit Euler, 1/30 000 s"},
             {"fig4-right", "two particles with constraints, θ₂ = 0, pair 0.003° apart; explicit Euler, 1/30 000 s"},
             {"fig5-left",
              "two particles with constraints, θ₂ = 0, m₁ = 1 kg against m₁ = 1.01 kg; explicit Euler, 1/30 000 s"},
             {"fig5-right",
              "two particles with constraints, 90°/90°, mass ratios m₁/m₂ apart by 0.01; explicit Euler, 1/30 000 s"},
             {"fig8", "three particles with constraints, θ₂ = θ₃ = 0, pair 0.003° apart; explicit Euler, 1/30 000 s"}})
        EXPECT_EQ(subtitle_of(name), words) << name;
}

TEST(FigurePreset, OfASweepStatesOverrides) {
    for (const auto& [set, words] : std::vector<std::pair<std::string, std::string>>{
             {"grid.difference=0.25", "two links in angles, θ₂ = 0, pair 0.25° apart; explicit"},
             {"grid.difference=-0.25", ", pair 0.25° apart; explicit"},
             {"grid.quantity=\"energy_error\"", "two links in angles, θ₂ = 0; explicit Euler, 1/30 000 s"},
             {"system.angle_deg=[0, 30.5]", "two links in angles, θ₂ = 30.5°, pair"},
             {"system.omega_deg_per_s=[0, 5]", ", ω₁ = 0°/s, ω₂ = 5°/s, θ₂ = 0, pair"},
             {"system.integrator=\"rk4\"", "; "},
             {"system.step_s=\"1/1200\"", "; explicit Euler, 1/1200 s"},
             {"system.precision=\"quad\"", "; explicit Euler, 1/30 000 s, in quad"},
             {"b.model=\"constraints\"", "two links, θ₂ = 0, pair 0.003° apart, angles against constraints; explicit"},
             {"b.length_m=[1, 2]", ", l₂ = 1 m against l₂ = 2 m; explicit"},
             {"b.integrator=\"rk4\"", "pair 0.003° apart, explicit Euler against "},
             {"grid.x.key=\"theta2_deg\"", "two links in angles, θ₁ = 0, pair 0.003° apart"},
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
    EXPECT_NE(message.find("[series] quantity \"log_ratio\" needs sides that are released differently"),
              std::string::npos)
        << message;
}

class FigureErrors : public testing::TestWithParam<RefusedFigure> {};

/// "path:line:column: [table] key", then the value and the remedy.
TEST_P(FigureErrors, NamePlaceValueAndRemedy) {
    const auto& c = GetParam();
    const auto [code, message] = error_of([&] { figure_from("[scene]\nkind = \"" + c.kind + "\"\n" + c.text); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_EQ(message.rfind("presets/x.toml" + c.place, 0), 0u) << message;
    for (const auto& words : c.words) EXPECT_NE(message.find(words), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Sweep, FigureErrors, testing::ValuesIn(refused_figures_sweep));

INSTANTIATE_TEST_SUITE_P(Values, FigureErrors, testing::ValuesIn(refused_figures_values));

INSTANTIATE_TEST_SUITE_P(Chart, FigureErrors, testing::ValuesIn(refused_figures_chart));

INSTANTIATE_TEST_SUITE_P(Series, FigureErrors, testing::ValuesIn(refused_figures_series));

INSTANTIATE_TEST_SUITE_P(Others, FigureErrors, testing::ValuesIn(refused_figures_others));

TEST(FigureErrors, OfTheTopAreNamed) {
    const std::string scene = "\n[scene]\nkind = \"series\"\n[series]\nquantity = \"exponents\"";
    for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {"captions = \"x\"", "presets/x.toml:1:1: captions must be an array of strings; it is a string (\"x\")"},
             {"captions = [3]", "presets/x.toml:1:1: captions[0] must be a string; it is a whole number (3)"},
             {"erratum = 3", "presets/x.toml:1:1: erratum must be a string; it is a whole number (3)"},
             {"subtitel = \"x\"", "presets/x.toml:1:1: a preset has no \"subtitel\"; did you mean \"subtitle\"?"}}) {
        const auto [code, message] = error_of([&] { figure_from(text + scene); });
        EXPECT_EQ(code, ExitCode::bad_input);
        EXPECT_EQ(message.rfind(words, 0), 0u) << message;
    }
    const auto [code, message] = error_of([] { figure_from("curve = 3\n[scene]\nkind = \"series\""); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
    EXPECT_EQ(message.rfind("presets/x.toml:1:1: curve", 0), 0u) << message;
}

TEST(FigureErrors, UnsupportedMethodsAreReportedAtOnce) {
    const auto [code, message] = error_of([] {
        figure_from(
            "[scene]\nkind = \"grid\"\n[system]\nmodel = \"angles\"\n[grid]\ndifference = 1\n[grid.panel]\nkey = "
            "\"system.integrator\"\nvalues = [\"euler\", \"rattle\"]");
    });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_NE(message.find("\"rattle\""), std::string::npos) << message;
}

TEST(FigureErrors, OfTheCommandLineNameTheOption) {
    const auto [code, message] = error_of([] { figure_of("fig2-right", {"grid.x.step=0"}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_EQ(message, "--set grid.x.step: [grid.x] step must be > 0; it is 0");
    EXPECT_EQ(error_of([] { figure_of("poincare", {"system.integrator=\"rk4\""}); }).first, ExitCode::bad_input);
}

}  // namespace doppel::preset_test

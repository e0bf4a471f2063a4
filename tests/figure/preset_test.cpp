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

TEST(FigurePreset, AListOfOneNeedsNoBrackets) {
    const auto resolved = [](const std::string& captions, const std::string& energy) {
        return figure_from("captions = " + captions + "\n[scene]\nkind = \"section\"\n[section]\nenergy_J = " + energy)
            .resolved();
    };
    EXPECT_EQ(resolved("\"x\"", "12"), resolved("[\"x\"]", "[12]"));
}

TEST(FigurePreset, ScaleIsOfThePicture) {
    EXPECT_EQ(layout_of(figure_of("fig6").chart).picture, (Size{1600, 900}));
    EXPECT_EQ(layout_of(figure_of("fig6", {"chart.scale=2", "chart.size=[480, 270]"}).chart).picture, (Size{960, 540}));
}

TEST(FigurePreset, IsNoFilm) {
    expect_refused({"doppel render butterfly"}, [] { read_figure(find_preset("butterfly")); });
    expect_refused({"doppel figure fig2-right"}, [] { read_preset(find_preset("fig2-right")); });
    // a user's preset is not a built-in name
    expect_refused({"doppel render base.toml"}, [] { read_figure({"base", "base.toml", "", "base.toml"}); });
    expect_refused({"doppel figure my/x.toml"}, [] {
        read_preset({"x", "my/x.toml", "[scene]\nkind = \"grid\"", "my/x.toml"});
    });
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

class FigureErrors : public testing::TestWithParam<RefusedFigure> {};

/// "path:line:column: [table] key", then the value and the remedy.
TEST_P(FigureErrors, NamePlaceValueAndRemedy) {
    expect_refused(GetParam().words, [&] { figure_from(GetParam().text); });
}

INSTANTIATE_TEST_SUITE_P(Figures, FigureErrors, testing::ValuesIn(refused_figures()));

TEST(FigureErrors, OfTheTopAreNamed) {
    const std::string scene = "\n[scene]\nkind = \"series\"\n[series]\nquantity = \"exponents\"";
    for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {"captions = 3", "captions must be an array of strings; it is a whole number (3)"},
             {"captions = [3]", "captions[0] must be a string; it is a whole number (3)"},
             {"erratum = 3", "erratum must be a string; it is a whole number (3)"},
             {"subtitel = \"x\"", "a preset has no \"subtitel\"; did you mean \"subtitle\"?"}}) {
        expect_refused({"presets/x.toml:1:1: " + words}, [&] { figure_from(text + scene); });
    }
    expect_refused({"presets/x.toml:1:1: curve"}, [] { figure_from("curve = 3\n[scene]\nkind = \"series\""); });
}

TEST(FigureErrors, OfTheCommandLineNameTheOption) {
    expect_refused({"--set grid.x.step: [grid.x] step must be > 0; it is 0"},
                   [] { figure_of("fig2-right", {"grid.x.step=0"}); });
    expect_refused({}, [] { figure_of("poincare", {"system.integrator=\"rk4\""}); });
}

}  // namespace doppel::preset_test

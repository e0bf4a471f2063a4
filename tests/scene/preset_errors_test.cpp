#include "base/text.hpp"
#include "scene/refused_presets.hpp"
#include "scene/support.hpp"

#include <gtest/gtest.h>

namespace doppel::preset_errors_test {

std::string message_of(const std::string& text) {
    return refusal([&] { preset_from(text); });
}

TEST(PresetErrors, NamePlaceValueAndRemedy) {
    for (const auto& [text, message] : refused_presets) expect_refused(text, std::string("x.toml:") + message);
    for (const auto& [keys, message] : refused_video_keys) {
        const auto said = message_of(std::string("[video]\n") + keys);
        EXPECT_TRUE(said.starts_with("x.toml:2:")) << said;
        EXPECT_EQ(said.substr(said.find(": [") + 2), message);
    }
}

/// Non-ASCII characters are escaped.
TEST(PresetErrors, AreShortAndUtf8WhateverTheValue) {
    for (const char* start : {"", "a", "ab", "abc"}) {
        std::string text(start);
        for (int i = 0; i < 40; ++i) text += "é";
        const auto message = message_of("[scene]\nduration_s = \"" + text + "\"");
        EXPECT_TRUE(is_utf8(message)) << message;
        EXPECT_TRUE(message.ends_with("…")) << message;
        EXPECT_LT(message.size(), 160u);
    }
}

TEST(Overrides, NameTheOptionInPlaceOfALine) {
    const auto error = [](const std::vector<std::string>& arguments) {
        return refusal([&] { scene_of("butterfly", arguments); });
    };
    EXPECT_EQ(error({"b.mass_kg=[1, -1]"}), "--set b.mass_kg: [b] mass_kg[1] must be > 0; it is -1");
    EXPECT_EQ(error({"system.lenght_m=[1, 1]"}),
              R"(--set system.lenght_m: [system] has no "lenght_m"; did you mean "length_m"?)");
    EXPECT_EQ(error({"nonsense"}), R"(--set must be table.key=VALUE; it is "nonsense")");
    EXPECT_EQ(error({"video.crf=1", "video.crf=2"}), "video.crf is given twice: --set video.crf and --set video.crf");
    EXPECT_EQ(error({"foo.bar=3"}),
              R"(--set foo.bar: a preset has no "foo"; it has a, b, scene, subtitle, system, title, video)");
    EXPECT_TRUE(error({"video.foo.bar=3"}).starts_with(R"(--set video.foo.bar: [video] has no "foo"; )"));
    EXPECT_EQ(error({"system.links=3", "system={}"}),
              "--set system: would remove --set system.links, which was given before; give the table first");
    EXPECT_EQ(error({"scene.kind=grid"}), R"(--set scene.kind: [scene] kind must be "pair" for a film; it is "grid")");
    EXPECT_EQ(error({"video.speed=1000"}),
              "--set video.speed: [video] speed times sample_hz, the frames a second without fps, must be at most 1000 "
              "and a fraction of whole numbers up to 1000000; it is 120000; set fps");
    EXPECT_EQ(refusal([] { scene_of("driven", {"system.torque.amplitude_N_m=2"}); }),
              "--set system.torque.amplitude_N_m: needs the name of an entry of [[system.torque]]: "
              "system.torque.NAME.amplitude_N_m");
    EXPECT_EQ(error({"title.x=1"}), R"(--set title.x: "title" is not a table)");
    EXPECT_TRUE(says(error({"video.theme=2dark"}), "a string needs quotes: 'video.theme=\"…\"'"));
    EXPECT_EQ(error({"video.crf=1\nx=2"}), "--set video.crf: \"1 x=2\" is more than one value");
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

TEST(PresetErrors, OfASideHaveThePlaceOfTheirEntry) {
    const std::string
        chain = "[system]\nangle_deg = [90, 0]\n[[system.constraint]]\nkind = \"anchor\"\nparticle = \"bob2\"\n",
        again = "[[a.constraint]]\nkind = \"anchor\"\nparticle = \"bob2\"\n";
    const auto words = refusal([&] { scene_from(chain + again); });
    EXPECT_TRUE(words.starts_with("x.toml:7:1: side a: constraint 4 (anchor of particle 2) is redundant: ")) << words;
    const auto on_b = refusal([&] { scene_from(chain, {"b.constraint=[{kind=\"anchor\", particle=\"bob2\"}]"}); });
    EXPECT_TRUE(on_b.starts_with("--set b.constraint: side b: constraint 4 ")) << on_b;
}

TEST(FindPreset, AdvisesTheCommandForFiguresAndFilms) {
    const auto message = [](const PresetText& source) { return refusal([&] { read_preset(source); }); };
    EXPECT_EQ(message(find_preset("fig6")),
              "presets/figures/fig6.toml: this is a figure, not a film; draw it with: doppel figure fig6");
    const auto path = std::string(DOPPEL_SOURCE_DIR) + "/presets/figures/fig6.toml";
    EXPECT_EQ(message(find_preset(path)), path + ": this is a figure, not a film; draw it with: doppel figure " + path);
}

TEST(FindPreset, NamesTheNearestOrWhatIsInItsPlace) {
    const auto missing = [](const char* name) { return refusal([&] { find_preset(name); }); };
    EXPECT_EQ(missing("buterfly"), R"(there is no preset "buterfly"; did you mean "butterfly"?)");
    EXPECT_EQ(missing("x/y.toml"), "x/y.toml: there is no such preset");
    EXPECT_EQ(missing("/"), "/ is a folder; a preset is a TOML file");
    EXPECT_TRUE(says(missing("qqqqqqqqqq"), "there are bifurcation, butterfly, calm"));
}

}  // namespace doppel::preset_errors_test

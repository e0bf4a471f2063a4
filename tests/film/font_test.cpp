#include "film/runs.hpp"
#include "film/words.hpp"
#include "output/written.hpp"
#include "render/font_files.hpp"
#include "scene/resolved.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace doppel::font_test {

namespace fs = std::filesystem;

/// A film's preset in a folder with a font that is twice as wide.
fs::path folder_with_font() {
    const auto folder = test::fresh_folder();
    test::write_bytes(folder / "wide.ttf", test::font_of_half_the_units());
    test::write_bytes(folder / "film.toml",
                      "title = \"Two\"\n[scene]\nduration_s = 1\n[b]\nangle_deg = [91, 90]\n"
                      "[video]\nsize = [480, 270]\n[video.fonts]\ntext = \"wide.ttf\"\n");
    return folder;
}

TEST(Fonts, AFilmsTextIsInTheUsersFontAndFits) {
    const auto folder = folder_with_font();
    const auto scene = scene_of(folder / "film.toml"), usual = scene_of("butterfly", {"video.size=[480, 270]"});
    const auto& type = scene.preset.video.typeface;
    EXPECT_EQ(*scene.preset.video.text_font, (folder / "wide.ttf").string());
    const auto size_of = [](const std::vector<Label>& labels, const std::string& text) {
        return std::find_if(labels.begin(), labels.end(), [&](const auto& label) { return label.text == text; })->size;
    };
    const auto labels = labels_of(scene, 60);
    // text that does not fit shrinks: the subtitle, not the short title
    EXPECT_LT(size_of(labels, "real time"), 10);
    EXPECT_EQ(size_of(labels, "Two"), 14);
    expect_apart(labels, {480, 270}, "wide", type);  // large letters: twice the height that box_of() takes
    EXPECT_NE(frame_of(scene, 0).rgba,
              frame_of(scene_of(folder / "film.toml",
                                {"video.fonts.text=\"" + std::string(DOPPEL_SOURCE_DIR) + "/fonts/DejaVuSans.ttf\""}),
                       0)
                  .rgba);
}

/// Except for bold text: the single file has no bold face.
TEST(Fonts, TheBuiltInFontByItsPathIsTheBuiltInFont) {
    const auto own = fmt::format("video.fonts.text=\"{}/fonts/DejaVuSans.ttf\"", DOPPEL_SOURCE_DIR);
    const std::string size = "video.size=[320, 180]", regular = "video.show=[\"subtitle\", \"clock\"]";
    EXPECT_EQ(frame_of(scene_of("butterfly", {size, regular, own}), 0).rgba,
              frame_of(scene_of("butterfly", {size, regular}), 0).rgba);
}

TEST(Fonts, AResolvedPresetFindsItsFontAgain) {
    const auto folder = folder_with_font();
    const auto scene = scene_of(folder / "film.toml");
    const auto again = read_preset({"x", "elsewhere/x.toml", resolved_toml(scene.preset), "x.toml"});
    EXPECT_EQ(again.video.text_font, scene.preset.video.text_font);
    EXPECT_EQ(again.video.typeface.width("Two", 20), scene.preset.video.typeface.width("Two", 20));
    EXPECT_FALSE(scene_of("butterfly", {"video.fonts.text=\"\""}).preset.video.text_font);
    EXPECT_EQ(resolved_toml(read_preset(find_preset("butterfly"))).find("video.fonts]"), std::string::npos);
}

TEST(Fonts, AFileThatIsNoneIsNamedWithItsKey) {
    const auto folder = folder_with_font();
    const auto message = [&](const std::string& file) {
        const auto [code, text] = error_of([&] {
            read_preset({"film", "p/film.toml", "[video.fonts]\ntext = \"" + file + "\"\n", "film"});
        });
        EXPECT_EQ(code, ExitCode::bad_input);
        return text;
    };
    EXPECT_EQ(message("none.ttf"), "p/film.toml:2:1: [video.fonts] text none.ttf: there is no such file");
    EXPECT_EQ(message((folder / "film.toml").string()),
              fmt::format("p/film.toml:2:1: [video.fonts] text {}: is no TrueType or OpenType font, or is damaged",
                          (folder / "film.toml").string()));
    EXPECT_EQ(error_of([] { scene_of("butterfly", {"video.fonts.text=\"no.ttf\""}); }).second,
              "--set video.fonts.text: [video.fonts] text no.ttf: there is no such file");
}

TEST(Fonts, AreInTheManifest) {
    const auto folder = folder_with_font();
    const auto font = folder / "wide.ttf";
    EXPECT_EQ(manifest_of(scene_of(folder / "film.toml"), folder / "out")["fonts"],
              (nlohmann::json{{font.string(), sha256_of_file(font)}}));
    EXPECT_FALSE(manifest_of(scene_of("calm", {"scene.duration_s=0.1"})).contains("fonts"));
}

TEST(Fonts, PresetsOfDoppelLookTheSameEverywhere) {
    for (const auto& source : builtin_presets()) {
        if (is_figure(source)) continue;
        const auto preset = read_preset(source);
        for (const auto& text : {preset.title, preset.subtitle.value_or(""), preset.a.label.value_or(""),
                                 preset.a.note.value_or(""), preset.b.label.value_or(""), preset.b.note.value_or("")})
            EXPECT_EQ(Typeface().missing_character(text), "") << preset.name << ": " << text;
        EXPECT_FALSE(preset.video.text_font) << preset.name;
    }
}

}  // namespace doppel::font_test

#include "render/typeface.hpp"

#include "errors.hpp"
#include "render/font_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace doppel::typeface_test {

namespace fs = std::filesystem;
/// A file with these bytes.
fs::path file_of(const std::string& bytes) {
    const auto folder = fs::path(DOPPEL_TEST_OUTPUT) / testing::UnitTest::GetInstance()->current_test_info()->name();
    fs::create_directories(folder);
    std::ofstream(folder / "x.ttf", std::ios::binary) << bytes;
    return folder / "x.ttf";
}

Typeface with(const std::string& bytes) {
    return Typeface::with_system_fonts(Font::from_file(file_of(bytes)));
}

/// The error of a font's file, without the file's name at its start.
test::Thrown error_of(const fs::path& path) {
    auto [code, message] = test::thrown_by([&] { Font::from_file(path); });
    if (message.starts_with(path.string())) message.erase(0, path.string().size());
    return {code, message};
}

TEST(Typefaces, TheUsersFontComesFirst) {
    const auto wide = with(test::font_of_half_the_units());
    const float usual = Typeface().width("Runge–Kutta 4", 20);
    for (const auto weight : {Weight::regular, Weight::bold})
        EXPECT_EQ(wide.width("Runge–Kutta 4", 20, weight), 2 * usual) << "a file has one weight";
    EXPECT_EQ(text_width("Runge–Kutta 4", 20), usual);  // other typefaces are unchanged
    EXPECT_EQ(wide.lay_out("a", 20, Weight::regular).width, 2 * Typeface().lay_out("a", 20, Weight::regular).width);
}

TEST(Typefaces, ALetterWithoutAnOutlineIsOfTheNextFont) {
    // as in fonts of coloured emoji; a space has no outline either
    const auto without_q = with(test::font_without("Q"));
    const auto line = without_q.lay_out("PQ ", 20, Weight::regular);
    EXPECT_NE(line.glyphs[0].font, &Font::built_in());
    EXPECT_EQ(line.glyphs[1].font, &Font::built_in());
    EXPECT_NE(line.glyphs[1].number, 0);
    EXPECT_EQ(line.glyphs[2].font, line.glyphs[0].font);
    EXPECT_EQ(without_q.missing_character("PQ "), "");
}

TEST(Typefaces, LettersOfNoFontAreMissing) {
    const std::string unassigned = "\xcd\xb8";  // U+0378
    for (const auto& typeface : {Typeface(), Typeface::with_system_fonts()}) {
        EXPECT_EQ(typeface.missing_character("a" + unassigned + "b"), unassigned);
        EXPECT_EQ(typeface.lay_out(unassigned, 20, Weight::regular).glyphs[0].number, 0);
        EXPECT_EQ(typeface.missing_character("Ärger, θ₁ = 90°"), "");
        // joining letters and right-to-left text are not supported
        for (const std::string letter : {"א", "م", "क", "က", "ﷺ"})
            EXPECT_EQ(typeface.missing_character("a" + letter), letter);
    }
}

TEST(Typefaces, VariationSelectorsTakeNoSpace) {
    EXPECT_EQ(text_width("⊕\xef\xb8\x8e", 20), text_width("⊕", 20));  // U+FE0E: as text
    EXPECT_EQ(Typeface().missing_character("⊕\xef\xb8\x8e"), "");
}

TEST(Typefaces, FilesThatAreNoFontAreRefused) {
    const auto font = test::embedded_font();
    const test::Thrown none{ExitCode::bad_input, ": is no TrueType or OpenType font, or is damaged"};
    for (const auto* bytes : {"", "true", "A text of some length, and no font."})
        EXPECT_EQ(error_of(file_of(bytes)), none) << bytes;
    for (const std::size_t bytes : {20u, 200u, 20000u})
        EXPECT_EQ(error_of(file_of(font.substr(0, bytes))), none) << bytes;
    EXPECT_EQ(error_of(file_of(test::font_without_table("glyf"))),
              (test::Thrown{ExitCode::bad_input, ": is a font without outlines"}));
    EXPECT_EQ(error_of(file_of(font)).first, ExitCode::done);
    EXPECT_EQ(error_of("/none.ttf").second, ": there is no such file");
    EXPECT_EQ(error_of("/dev/zero").second, " is not a file; a font is a TrueType or OpenType file");
    EXPECT_EQ(error_of("/").second, " is a folder; a font is a TrueType or OpenType file");
}

TEST(Typefaces, SystemFontsHaveWhatTheOthersLack) {
    const std::string letter = "双";
    const auto typeface = Typeface::with_system_fonts();
    EXPECT_EQ(Typeface().missing_character(letter), letter);  // only a system font has it
    EXPECT_EQ(Typeface().missing_character("Ärger"), "");
    const Font* const font = system_font_for(U'双');
    if (!font) GTEST_SKIP() << "fontconfig knows no font with 双 here";
    EXPECT_EQ(typeface.missing_character(letter), "");
    const auto glyph = typeface.lay_out(letter, 40, Weight::regular).glyphs[0];
    EXPECT_EQ(glyph.font, font);
    EXPECT_GT(font->advance(glyph.number, 40), 20);
    EXPECT_EQ(system_font_for(U'双'), font);  // found once
}

}  // namespace doppel::typeface_test

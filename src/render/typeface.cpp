#include "render/typeface.hpp"

#include "base/error.hpp"
#include "base/owned.hpp"
#include "base/text.hpp"

#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <string>

namespace doppel {
namespace {

/// Selects a form of the preceding letter.
bool is_variation_selector(char32_t character) {
    return character >= 0xfe00 && character <= 0xfe0f;
}

}  // namespace

bool needs_shaping(char32_t character) {
    // Hebrew and Arabic to the scripts of India; Tibetan and Myanmar; Khmer and Mongolian; forms of Hebrew and Arabic
    constexpr std::array<std::pair<char32_t, char32_t>, 5> ranges{
        {{0x0590, 0x0dff}, {0x0f00, 0x109f}, {0x1780, 0x18af}, {0xfb1d, 0xfdff}, {0xfe70, 0xfefe}}};
    return std::ranges::any_of(
        ranges, [&](const auto& range) { return character >= range.first && character <= range.second; });
}

Point start_of(const Label& label, const TextLine& line) {
    const float before = label.align == Align::left ? 0 : label.align == Align::center ? 0.5f : 1;
    return {label.anchor.x - before * line.width, std::round(label.anchor.y)};
}

TextLine::Glyph Typeface::glyph_of(char32_t character, Weight weight) const {
    if (own_)
        if (const int number = own_->number_of(character)) return {own_.get(), number};
    const Font& built_in = Font::built_in(weight);
    const int number = built_in.number_of(character);
    if (number != 0 || !system_) return {&built_in, number};
    const Font* const found = system_font_for(character);
    return found ? TextLine::Glyph{found, found->number_of(character)} : TextLine::Glyph{&built_in, 0};
}

TextLine Typeface::lay_out(std::string_view text, float size, Weight weight) const {
    TextLine line;
    line.glyphs.reserve(text.size());
    const std::size_t bytes = text.size();
    while (!text.empty()) {
        const std::size_t byte = bytes - text.size();
        const char32_t character = next_character(text);
        if (is_variation_selector(character)) continue;
        auto& glyph = line.glyphs.emplace_back(glyph_of(character, weight));
        glyph.pen = line.width;
        glyph.byte = byte;
        line.width += glyph.font->advance(glyph.number, size);
    }
    return line;
}

float Typeface::width(std::string_view text, float size, Weight weight) const {
    return lay_out(text, size, weight).width;
}

float Typeface::fitting_size(std::string_view text, float size, Weight weight, float room) const {
    const float wanted = width(text, size, weight);
    return wanted > room ? size * std::max(room, 0.0f) / wanted : size;
}

std::string_view Typeface::missing_character(std::string_view text) const {
    while (!text.empty()) {
        const auto from = text;
        const char32_t character = next_character(text);
        if (is_variation_selector(character)) continue;
        if (is_control(character) || needs_shaping(character) || glyph_of(character).number == 0)
            return from.substr(0, from.size() - text.size());
    }
    return {};
}

std::set<std::filesystem::path> Typeface::files_of(std::string_view text) const {
    std::set<std::filesystem::path> files;
    for (const auto& glyph : lay_out(text, 1, Weight::regular).glyphs)
        if (const auto& file = glyph.font->file(); !file.empty()) files.insert(file);
    return files;
}

namespace {

using Config = Owned<FcConfig, FcConfigDestroy>;
using Pattern = Owned<FcPattern, FcPatternDestroy>;
using Letters = Owned<FcCharSet, FcCharSetDestroy>;
using Fonts = Owned<FcFontSet, FcFontSetDestroy>;

/// Fonts of the system with outlines, sorted by suitability for the letter.
Fonts fonts_for(FcConfig* config, char32_t letter) {
    const Pattern wanted(FcPatternCreate());
    const Letters letters(FcCharSetCreate());
    FcCharSetAddChar(letters.get(), letter);
    FcPatternAddCharSet(wanted.get(), FC_CHARSET, letters.get());
    FcPatternAddString(wanted.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddBool(wanted.get(), FC_OUTLINE, FcTrue);
    FcPatternAddBool(wanted.get(), FC_COLOR, FcFalse);
    FcConfigSubstitute(config, wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultNoMatch;
    return Fonts(FcFontSort(config, wanted.get(), FcFalse, nullptr, &result));
}

// What was found is kept for the rest of the process.

/// Null if it is no font with outlines. One thread at a time: system_font_for() has locked.
const Font* opened(const std::string& file, int index) {
    static std::map<std::pair<std::string, int>, std::shared_ptr<const Font>> fonts;
    const auto [place, is_new] = fonts.try_emplace({file, index});
    if (is_new) {
        try {
            place->second = Font::from_file(file, index);
        } catch (const Error&) {  // a type of font that Doppel does not read; the next may be readable
        }
    }
    return place->second.get();
}

const Font* find_font(char32_t letter) {
    static const Config config(FcInitLoadConfigAndFonts());
    if (!config) return nullptr;
    const auto fonts = fonts_for(config.get(), letter);
    for (int i = 0; fonts && i < fonts->nfont; ++i) {
        FcPattern* const found = fonts->fonts[i];
        FcCharSet* letters = nullptr;
        FcChar8* file = nullptr;
        int index = 0;
        if (FcPatternGetCharSet(found, FC_CHARSET, 0, &letters) != FcResultMatch ||
            FcCharSetHasChar(letters, letter) == FcFalse ||
            FcPatternGetString(found, FC_FILE, 0, &file) != FcResultMatch)
            continue;
        FcPatternGetInteger(found, FC_INDEX, 0, &index);
        // the upper 16 bits number an instance of a variable font; the default instance is used
        const auto* font = opened(reinterpret_cast<const char*>(file), index & 0xffff);
        if (font && font->number_of(letter) != 0) return font;
    }
    return nullptr;
}

}  // namespace

const Font* system_font_for(char32_t character) {
    static std::mutex mutex;
    static std::map<char32_t, const Font*> fonts;
    const std::lock_guard lock(mutex);
    const auto [place, is_new] = fonts.try_emplace(character, nullptr);
    if (is_new) place->second = find_font(character);
    return place->second;
}

}  // namespace doppel

#include "render/typeface.hpp"

#include "base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
        line.width += glyph.font->advance(glyph.number, size, weight);
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

}  // namespace doppel

#pragma once

#include "render/font.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

struct TextLine {
    struct Glyph {
        const Font* font = nullptr;  // of the typeface
        int number = 0;              // glyph number in the font; 0 = nothing is drawn
        float pen = 0;               // px right of the start of the line
        std::size_t byte = 0;        // index in the text of its character's first byte
    };
    std::vector<Glyph> glyphs;
    float width = 0;  // px
};

/// The start of the pen, px.
Point start_of(const Label& label, const TextLine& line);

/// A list of fonts. Each letter uses the first font that contains it: the user's font, the built-in font, then, if
/// allowed, fonts of the system. Copies share their fonts.
class Typeface {
public:
    /// Only the built-in font, which gives the same picture everywhere.
    Typeface() = default;
    static Typeface with_system_fonts(std::shared_ptr<const Font> own = nullptr) { return {std::move(own), true}; }

    /// The advance width of `text`, px, equal to that of the drawn text.
    float width(std::string_view text, float size, Weight weight = Weight::regular) const;
    /// `size`, or the smaller size at which `text` is `width` px wide.
    float fitting_size(std::string_view text, float size, Weight weight, float width) const;
    /// Text is UTF-8; malformed bytes become U+FFFD. Variation selectors (U+FE00 … U+FE0F) are left out.
    TextLine lay_out(std::string_view text, float size, Weight weight) const;

    /// The first character of `text` that no font contains, or that cannot be set as a separate letter from left to
    /// right (control characters, Arabic …). Empty if there is none.
    std::string_view missing_character(std::string_view text) const;

    /// The files of the fonts used for `text`, except the built-in one.
    std::set<std::filesystem::path> files_of(std::string_view text) const;

    bool uses_system_fonts() const { return system_; }
    /// The user's font; null if there is none.
    const Font* own() const { return own_.get(); }

private:
    Typeface(std::shared_ptr<const Font> own, bool system) : own_(std::move(own)), system_(system) {}
    TextLine::Glyph glyph_of(char32_t character, Weight weight = Weight::regular) const;

    std::shared_ptr<const Font> own_;  // the user's
    bool system_ = false;
};

/// Whether the script joins its letters or runs from right to left. Doppel sets single letters from left to right.
bool needs_shaping(char32_t character);

/// A system font with an outline for the letter, found by fontconfig; null if there is none.
const Font* system_font_for(char32_t character);

// Set in the built-in font, as in charts.

inline float text_width(std::string_view text, float size, Weight weight = Weight::regular) {
    return Typeface().width(text, size, weight);
}
inline float fitting_size(std::string_view text, float size, Weight weight, float width) {
    return Typeface().fitting_size(text, size, weight, width);
}

}  // namespace doppel

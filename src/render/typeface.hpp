#pragma once

#include "render/font.hpp"

#include <filesystem>
#include <memory>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {

/// A line of positioned glyphs.
struct TextLine {
    struct Glyph {
        const Font* font = nullptr;  // one of the typeface's
        int number = 0;              // in the font; 0 = a hollow box
        float pen = 0;               // px right of the start of the line
        std::size_t byte = 0;        // where its character begins in the text
    };
    std::vector<Glyph> glyphs;
    float width = 0;  // px
};

/// Where the pen begins, px.
Point start_of(const Label& label, const TextLine& line);

/// The fonts of a text. Each letter is of the first that has it: a file of the user's, the built-in font, a font of the
/// system where these are allowed. Copies share their fonts.
class Typeface {
public:
    /// The built-in font alone: the same picture everywhere.
    Typeface() = default;
    /// With the system's fonts behind the built-in one, and one of the user's before it.
    static Typeface with_system_fonts(std::shared_ptr<const Font> own = nullptr) { return {std::move(own), true}; }

    /// The advance width of `text`, px, exactly as it is drawn.
    float width(std::string_view text, float size, Weight weight = Weight::regular) const;
    /// `size`, or as much less as makes `text` no wider than `width` px.
    float fitting_size(std::string_view text, float size, Weight weight, float width) const;
    /// Text is UTF-8; each byte that is not becomes U+FFFD. Signs that choose a form of a letter (U+FE00 … U+FE0F) are
    /// left out.
    TextLine lay_out(std::string_view text, float size, Weight weight) const;

    /// The first character of `text` that no font has, or that is none of a line of separate letters from left to right:
    /// a control character, Arabic … Empty where there is none.
    std::string_view missing_character(std::string_view text) const;
    /// Whether all of `text` is in the user's font or the built-in one: a system's fonts may differ from another's.
    bool has_own(std::string_view text) const;

    /// The files of the fonts that the letters of `text` are of, but for the built-in one.
    std::set<std::filesystem::path> files_of(std::string_view text) const;

    bool uses_system_fonts() const { return system_; }
    /// The user's font; null where there is none.
    const Font* own() const { return own_.get(); }

private:
    Typeface(std::shared_ptr<const Font> own, bool system) : own_(std::move(own)), system_(system) {}
    TextLine::Glyph glyph_of(char32_t character, bool in_system, Weight weight = Weight::regular) const;

    std::shared_ptr<const Font> own_;  // the user's
    bool system_ = false;
};

/// Whether letters of its script join, or run from right to left: Doppel sets letter by letter from the left.
bool needs_shaping(char32_t character);

/// A font of the system that has an outline for the letter, found through fontconfig; null where there is none.
const Font* system_font_for(char32_t character);

// In the built-in font, as charts are.

inline float text_width(std::string_view text, float size, Weight weight = Weight::regular) {
    return Typeface().width(text, size, weight);
}
inline float fitting_size(std::string_view text, float size, Weight weight, float width) {
    return Typeface().fitting_size(text, size, weight, width);
}

}  // namespace doppel

#pragma once

#include "render/display_list.hpp"

#include <string_view>
#include <vector>

namespace doppel {

/// How far the pen moves along `text`, px; the same arithmetic that places the glyphs when it is drawn.
float text_width(std::string_view text, float size, Weight weight = Weight::regular);

/// `size`, or as much less as makes `text` no wider than `width` px.
float fitting_size(std::string_view text, float size, Weight weight, float width);

/// A line of text as the pen writes it.
struct TextLine {
    struct Glyph {
        int number = 0;  // in the font
        float pen = 0;   // px right of the start of the line
    };
    std::vector<Glyph> glyphs;
    float width = 0;  // px
};

/// Text is UTF-8; each byte that is not becomes U+FFFD.
TextLine lay_out(std::string_view text, float size, Weight weight);

/// The first character of `text` that would be drawn as a hollow box, or not at all: one that the font lacks, or a
/// control character. Empty where there is none.
std::string_view lacking_character(std::string_view text);

}  // namespace doppel

#include "picture/font.hpp"

#include "picture/glyphs.hpp"

#include <algorithm>
#include <cstddef>

namespace doppel {
namespace {

constexpr char32_t replacement = 0xfffd;

/// Takes the next character off the front of `text`: one byte, and U+FFFD, where it is not well-formed UTF-8.
char32_t next_character(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    char32_t character = length <= 1 ? first : first & (0x7fu >> length);
    bool well_formed = length > 0 && first < 0xf5 && text.size() >= length;
    for (std::size_t i = 1; well_formed && i < length; ++i) {
        well_formed = (byte(i) & 0xc0u) == 0x80;
        character = character << 6 | (byte(i) & 0x3fu);
    }
    // neither longer than need be, nor half a surrogate pair, nor past the end of Unicode
    well_formed = well_formed && !(length == 3 && (character < 0x800 || (character >> 11) == 0x1b)) &&
                  !(length == 4 && (character < 0x10000 || character > 0x10ffff));
    text.remove_prefix(well_formed ? length : 1);
    return well_formed ? character : replacement;
}

}  // namespace

TextLine lay_out(std::string_view text, float size, Weight weight) {
    TextLine line;
    line.glyphs.reserve(text.size());
    while (!text.empty()) {
        const int number = glyphs::number_of(next_character(text));
        line.glyphs.push_back({number, line.width});
        line.width += glyphs::advance(number, size, weight);
    }
    return line;
}

float fitting_size(std::string_view text, float size, Weight weight, float width) {
    const float wanted = text_width(text, size, weight);
    return wanted > width ? size * std::max(width, 0.0f) / wanted : size;
}

float text_width(std::string_view text, float size, Weight weight) {
    return lay_out(text, size, weight).width;
}

}  // namespace doppel

#pragma once

#include "render/typeface.hpp"

#include <cstddef>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace doppel::test {

// Modified copies of the built-in font.

inline std::string embedded_font() {
    std::ifstream file(std::string(DOPPEL_SOURCE_DIR) + "/fonts/DejaVuSans.ttf", std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The position of a table's entry in the font's directory: name, checksum, offset, length, four bytes each.
inline std::size_t entry_of(const std::string& font, std::string_view table) {
    return font.find(table, 12);
}
inline std::size_t number_at(const std::string& font, std::size_t at, int bytes = 4) {
    std::size_t value = 0;
    for (int i = 0; i < bytes; ++i)
        value = value << 8 | static_cast<unsigned char>(font[at + static_cast<std::size_t>(i)]);
    return value;
}

/// Letters are twice as large at the same font size.
inline std::string font_of_half_the_units() {
    auto font = embedded_font();
    const std::size_t units_per_em = number_at(font, entry_of(font, "head") + 8) + 18;
    font[units_per_em] = static_cast<char>(font[units_per_em] / 2);
    return font;
}

/// The letter has an empty glyph.
inline std::string font_without(std::string_view letter) {
    auto font = embedded_font();
    const auto glyph = static_cast<std::size_t>(Typeface().lay_out(letter, 1, Weight::regular).glyphs[0].number);
    const bool is_long = number_at(font, number_at(font, entry_of(font, "head") + 8) + 50, 2) == 1;
    const std::size_t size = is_long ? 4 : 2, begin = number_at(font, entry_of(font, "loca") + 8) + glyph * size;
    font.replace(begin, size, font.substr(begin + size, size));
    return font;
}

inline std::string font_without_table(std::string_view table) {
    auto font = embedded_font();
    font[entry_of(font, table)] = '?';
    return font;
}

}  // namespace doppel::test

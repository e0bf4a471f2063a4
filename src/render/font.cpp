#include "render/font.hpp"

#include "base/text.hpp"
#include "render/glyphs.hpp"

#include <algorithm>

namespace doppel {

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

std::string_view lacking_character(std::string_view text) {
    while (!text.empty()) {
        const auto from = text;
        const auto character = next_character(text);
        if (is_control(character) || glyphs::number_of(character) == 0)
            return from.substr(0, from.size() - text.size());
    }
    return {};
}

}  // namespace doppel

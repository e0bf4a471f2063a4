#include "scene/toml_text.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace doppel {

TomlText::TomlText(std::string text) : text_(std::move(text)) {
    constexpr std::size_t apart = 256;
    std::size_t characters = 0;
    for (Place place{1, 1, 0}; place.offset < text_.size(); step(place))
        if (characters++ % apart == 0) milestones_.push_back(place);
}

/// On to the next character of UTF-8.
void TomlText::step(Place& place) const {
    const bool ends_line = text_[place.offset] == '\n';
    const auto continues = [&] { return (static_cast<unsigned char>(text_[place.offset]) & 0xC0) == 0x80; };
    do ++place.offset;
    while (place.offset < text_.size() && continues());
    ++place.column;
    if (ends_line) ++place.line, place.column = 1;
}

std::string TomlText::literal_at(std::size_t line, std::size_t column) const {
    auto place = Place{1, 1, 0};
    const auto next = std::partition_point(milestones_.begin(), milestones_.end(),
                                           [&](const Place& stone) { return stone.is_before(line, column); });
    if (next != milestones_.begin()) place = *std::prev(next);
    while (place.is_before(line, column) && place.offset < text_.size()) step(place);
    const auto rest = std::string_view(text_).substr(place.offset);
    std::string digits;
    for (const char byte : rest.substr(0, rest.find_first_not_of("0123456789+-._eE")))
        if (byte != '_') digits += byte;
    return digits;
}

}  // namespace doppel

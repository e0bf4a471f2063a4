#include "scene/toml_reader.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <utility>

namespace doppel {
namespace {

std::string written(const toml::node& node) {
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    if (const auto* array = node.as_array()) {
        std::string text;
        for (const auto& element : *array) text += (text.empty() ? "" : ", ") + written(element);
        return fmt::format("[{}]", text);
    }
    std::ostringstream out;
    node.visit([&](const auto& n) { out << toml::toml_formatter{n, toml::format_flags::none}; });
    return out.str();
}

}  // namespace

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

std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table:
            return "a table";
        case toml::node_type::array:
            return "an array";
        case toml::node_type::string:
            return "a string";
        case toml::node_type::integer:
            return "a whole number";
        case toml::node_type::floating_point:
            return "a decimal number";
        case toml::node_type::boolean:
            return "a boolean";
        default:
            return "a date or time";
    }
}

std::string shown(const toml::node& node) {
    auto text = written(node);
    std::replace(text.begin(), text.end(), '\n', ' ');
    constexpr std::size_t most = 60;
    return text.size() > most ? text.substr(0, most - 1) + "…" : text;
}

std::string found(const toml::node& node) {
    return fmt::format("it is {} ({})", kind_of(node), shown(node));
}

}  // namespace doppel

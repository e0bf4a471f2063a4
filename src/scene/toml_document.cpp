#include "base/text.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <sstream>
#include <utility>

namespace doppel {
namespace {

constexpr int most_parts = 8;  // of a key; Doppel's own have three at most

/// Past the string that begins at `at`, or to where it breaks off.
std::size_t past_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string triple(3, quote);
    const bool has_lines = text.substr(at, 3) == triple;
    const std::string_view end = has_lines ? triple : std::string_view(triple).substr(0, 1);
    for (at += end.size(); at < text.size(); ++at) {
        if (quote == '"' && text[at] == '\\') {
            ++at;
        } else if (text.substr(at, end.size()) == end) {
            at += end.size();
            for (int i = 0; i < 2 && has_lines && at < text.size() && text[at] == quote; ++i) ++at;  // its own last two
            return at;
        } else if (!has_lines && text[at] == '\n') {
            return at;
        }
    }
    return text.size();
}

/// Every part of a key makes a table, and taking thousands of them down, one inside the other, would overflow the
/// stack, whether the rest is TOML or not: so deep keys are found before the text is parsed.
void bound_keys(std::string_view text, const std::string& path) {
    const auto in_key = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == ' ' || c == '\t' ||
               static_cast<unsigned char>(c) >= 0x80;
    };
    int dots = 0;
    for (std::size_t at = 0; at < text.size();) {
        const char c = text[at];
        if (c == '"' || c == '\'') {
            at = past_string(text, at);
            continue;
        }
        if (c == '#') {
            at = std::min(text.find('\n', at), text.size());
            continue;
        }
        if (c == '.')
            ++dots;
        else if (!in_key(c))
            dots = 0;
        if (dots == most_parts) {
            const auto before = text.substr(0, at);
            throw bad_input("{}:{}:{}: a key may have {} parts; this one has more", path,
                            1 + std::count(before.begin(), before.end(), '\n'), at - before.rfind('\n'), most_parts);
        }
        ++at;
    }
}

toml::table parse(const std::string& text, const std::string& path, TomlTexts& texts) {
    try {
        texts.insert_or_assign(path, TomlText(text));
        bound_keys(text, path);
        return toml::parse(text, path);
    } catch (const toml::parse_error& fault) {
        const auto at = fault.source().begin;
        throw bad_input("{}:{}:{}: {}", path, at.line, at.column, fault.description());
    }
}

/// The value of `change`, in a table of its own.
toml::table given_by(const Override& change, TomlTexts& texts) {
    const auto& text = texts.insert_or_assign(change.origin, TomlText("value = " + change.value)).first->second.text();
    bound_keys(text, change.origin);
    try {
        return toml::parse(text, change.origin);
    } catch (const toml::parse_error& fault) {
        throw bad_input("{}: \"{}\" is no TOML value ({}); strings want quotes: '{}=\"{}\"'", change.origin,
                        change.value, fault.description(), change.key, change.value);
    }
}

/// Puts the value of `change` into the tables of `root`, in place of what is there.
void apply(toml::table& root, const Override& change, TomlTexts& texts) {
    auto dot = change.key.find('.');
    toml::table* table = &root;
    std::string key = change.key;
    for (; dot != std::string::npos; dot = key.find('.')) {
        const auto head = key.substr(0, dot);
        if (!table->contains(head)) table->insert(head, toml::parse("", change.origin));  // knows its origin
        table = table->get_as<toml::table>(head);
        if (!table) throw bad_input("{}: \"{}\" is no table", change.origin, head);
        key = key.substr(dot + 1);
    }
    auto given = given_by(change, texts);
    if (given.size() != 1) throw bad_input("{}: \"{}\" is more than one value", change.origin, change.value);
    // moved, not copied: a copy would forget where it comes from
    std::move(*given.get("value")).visit([&]<class Node>(Node&& node) {
        table->erase(key);
        table->insert(key, std::forward<Node>(node));
    });
}

void apply(toml::table& root, const std::vector<Override>& overrides, TomlTexts& texts) {
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        const auto& change = overrides[i];
        for (std::size_t j = 0; j < i; ++j) {
            const auto& before = overrides[j];
            if (change.key == before.key)
                throw bad_input("{} is given twice: {} and {}", change.key, before.origin, change.origin);
            if (before.key.starts_with(change.key + "."))
                throw bad_input("{}: would drop {}, which was given before it; give the table first", change.origin,
                                before.origin);
        }
        apply(root, change, texts);
    }
}

}  // namespace

TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides) {
    TomlDocument document{.path = source.path, .root = {}, .texts = {}};
    // no part of the text: the parser would not count it as a column
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    const bool is_marked = source.text.starts_with(byte_order_mark);
    document.root = parse(source.text.substr(is_marked ? byte_order_mark.size() : 0), source.path, document.texts);
    apply(document.root, overrides, document.texts);
    return document;
}

Override parse_set(const std::string& argument) {
    const auto equals = argument.find('=');
    const auto key = argument.substr(0, equals);
    if (equals == std::string::npos || key.empty() || key.starts_with('.') || key.ends_with('.') ||
        key.find("..") != std::string::npos)
        throw bad_input("--set wants table.key=VALUE; it is \"{}\"", argument);
    if (const auto parts = 1 + std::count(key.begin(), key.end(), '.'); parts > most_parts)
        throw bad_input("--set wants a key of at most {} parts; this one has {}", most_parts, parts);
    return {key, argument.substr(equals + 1), "--set " + key};
}

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
    return text.size() > most ? shortened(text, most - 1) : text;
}

std::string found(const toml::node& node) {
    return fmt::format("it is {} ({})", kind_of(node), shown(node));
}

}  // namespace doppel

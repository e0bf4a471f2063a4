#include "base/text.hpp"
#include "numeric/rational.hpp"
#include "scene/resolved.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <sstream>
#include <tuple>
#include <utility>

namespace doppel {
namespace {

constexpr int max_parts = 8;  // of a key; Doppel's keys have at most three

/// The position after the string that begins at `at`, or where it is broken off.
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
            for (int i = 0; i < 2 && has_lines && at < text.size() && text[at] == quote; ++i)
                ++at;  // up to two quotes at its end belong to it
            return at;
        } else if (!has_lines && text[at] == '\n') {
            return at;
        }
    }
    return text.size();
}

/// Throws if a key has too many parts. Each part makes a nested table; destroying thousands of nested tables would
/// overflow the stack. So this is checked before the text is parsed.
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
        if (dots == max_parts) {
            const auto before = text.substr(0, at);
            throw bad_input("{}:{}:{}: a key can have at most {} parts; this one has more", path,
                            1 + std::count(before.begin(), before.end(), '\n'), at - before.rfind('\n'), max_parts);
        }
        ++at;
    }
}

toml::table parse(const std::string& text, const std::string& path, TomlTexts& texts) {
    try {
        texts.insert_or_assign(path, TomlText(text));
        bound_keys(text, path);
        return toml::parse(text, path);
    } catch (const toml::parse_error& error) {
        const auto at = error.source().begin;
        throw bad_input("{}:{}:{}: {}", path, at.line, at.column, error.description());
    }
}

/// `value`, given by `change`, in a table of its own.
toml::table parsed_value(const Override& change, const std::string& value, TomlTexts& texts) {
    const auto& text = texts.insert_or_assign(change.origin, TomlText("value = " + value)).first->second.text();
    bound_keys(text, change.origin);
    auto given = toml::parse(text, change.origin);
    if (given.size() != 1) throw bad_input("{}: \"{}\" is more than one value", change.origin, change.value);
    return given;
}

bool is_toml(const std::string& value) {
    try {
        static_cast<void>(toml::parse("value = " + value));
        return true;
    } catch (const toml::parse_error&) {
        return false;
    }
}

/// Text that may be typed without quotes: "light", "1/1000", "#ff8800", "fonts/mine.ttf", "system.mass_kg[1]".
bool is_bare_text(std::string_view value) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (value.empty() || value[0] == '[' || value.find_first_of("\"'{}=,\\\n\r\t") != std::string_view::npos)
        return false;
    const bool is_fraction = parse_rational(std::string(value)).has_value();
    return is_fraction || !(is_digit(value[0]) || value[0] == '-' || value[0] == '+' || value[0] == '.');
}

/// The same for the value as typed.
toml::table given_by(const Override& change, TomlTexts& texts) {
    try {
        return parsed_value(change, change.value, texts);
    } catch (const toml::parse_error& error) {
        if (const auto quoted = toml_text(change.value);
            is_bare_text(change.value) && is_toml(quoted))  // also checks UTF-8
            return parsed_value(change, quoted, texts);
        const auto list = fmt::format("[{}]", change.value);
        const bool lacks_brackets = change.value.find(',') != std::string::npos && is_toml(list);
        throw bad_input("{}: \"{}\" is not a TOML value ({}); {}", change.origin, change.value, error.description(),
                        lacks_brackets
                            ? fmt::format("a list needs brackets: '{}={}'", change.key, list)
                            : fmt::format("a list is like [1, 2], and a string needs quotes: '{}=\"…\"'", change.key));
    }
}

std::string text_in(const toml::table& table, std::string_view key) {
    return table[key].value_or(std::string());
}

/// The entry of that name, or the only one of that kind. If a side does not mention an entry of [system], it gets a
/// table there. `key` = "system.force".
toml::table& entry_named(const toml::table& root, toml::array& entries, std::string_view key, const std::string& name,
                         const Override& change) {
    std::vector<toml::table*> of_kind;
    std::vector<std::string> names;
    for (auto& entry : entries) {
        auto* table = entry.as_table();
        if (!table) continue;
        if (text_in(*table, "name") == name) return *table;
        if (text_in(*table, "kind") == name) of_kind.push_back(table);
        if (auto own = text_in(*table, "name"); !own.empty()) names.push_back(std::move(own));
    }
    if (of_kind.size() == 1) return *of_kind.front();
    const auto table = key.substr(key.find('.') + 1);
    if (const auto* of_both = root["system"][table].as_array(); of_both && of_both != &entries)
        for (const auto& entry : *of_both)
            if (entry.is_table() && text_in(*entry.as_table(), "name") == name) {
                entries.push_back(toml::parse("name = " + toml_text(name), change.origin));
                return *entries.back().as_table();
            }
    throw bad_input(
        "{}: [[{}]] has {} \"{}\"; {}", change.origin, key, of_kind.empty() ? "no entry" : "several entries of kind",
        name,
        names.empty() ? "give the entry a name in the preset" : fmt::format("there are {}", fmt::join(names, ", ")));
}

/// Finds the innermost table of the key of `change`; `key` becomes the remaining key.
toml::table& table_of(toml::table& root, const Override& change, std::string& key) {
    toml::table* table = &root;
    std::string way;
    for (auto dot = key.find('.'); dot != std::string::npos; dot = key.find('.')) {
        const auto head = key.substr(0, dot);
        key = key.substr(dot + 1);
        const auto inside = key.rfind('.');
        const bool is_of_side = way == "a" || way == "b";
        way += (way.empty() ? "" : ".") + head;
        if (is_of_side && inside != std::string::npos && !table->contains(head) && root["system"][head].is_array())
            table->insert(head, toml::array());
        if (auto* entries = table->get_as<toml::array>(head); entries && inside != std::string::npos) {
            auto& entry = entry_named(root, *entries, way, key.substr(0, inside), change);
            key = key.substr(inside + 1);
            return entry;
        }
        if (!table->contains(head))
            table->insert(head, toml::parse("", change.origin));  // parsed, so that it has its origin
        if (table->get(head)->is_array_of_tables())
            throw bad_input("{}: needs the name of an entry of [[{}]]: {}.NAME.{}", change.origin, way, way, key);
        table = table->get_as<toml::table>(head);
        if (!table) throw bad_input("{}: \"{}\" is not a table", change.origin, head);
    }
    return *table;
}

/// Sets the value of `change` in the tables of `root`. An element, "mass_kg[1]", is stored as a key of its own for the
/// reader of the list.
void apply(toml::table& root, const Override& change, TomlTexts& texts) {
    std::string key = change.key;
    auto& table = table_of(root, change, key);
    std::optional<std::size_t> element;
    if (auto list = key; !take_element(list, element))
        throw bad_input("{}: an element of a list is written like system.mass_kg[1], the second", change.origin);
    auto given = given_by(change, texts);
    // moved: a copy would lose its origin
    std::move(*given.get("value")).visit([&]<class Node>(Node&& node) {
        table.erase(key);
        table.insert(key, std::forward<Node>(node));
    });
}

void apply(toml::table& root, const std::vector<Override>& overrides, TomlTexts& texts) {
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        const auto& change = overrides[i];
        for (std::size_t j = 0; j < i; ++j) {
            const auto& before = overrides[j];
            if (change.key == before.key)
                throw bad_input("{} is given twice: {} and {}", change.key, before.origin, change.origin);
            if (before.key.starts_with(change.key + ".") || before.key.starts_with(change.key + "["))
                throw bad_input("{}: would remove {}, which was given before; give the table first", change.origin,
                                before.origin);
        }
        apply(root, change, texts);
    }
}

}  // namespace

TomlDocument parse_document(const PresetText& source, const std::vector<Override>& overrides) {
    TomlDocument document{.path = source.path, .root = {}, .texts = {}};
    // removed, because the parser does not count it as a column
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    const bool is_marked = source.text.starts_with(byte_order_mark);
    document.root = parse(source.text.substr(is_marked ? byte_order_mark.size() : 0), source.path, document.texts);
    apply(document.root, overrides, document.texts);
    return document;
}

bool take_element(std::string& key, std::optional<std::size_t>& element) {
    const auto bracket = key.find('[');
    if (bracket == std::string::npos) return true;
    const char *first = key.data() + bracket + 1, *end = key.data() + key.size();
    const auto [after, error] = std::from_chars(first, end, element.emplace());
    const bool is_one = error == std::errc() && after + 1 == end && *after == ']';
    key.resize(bracket);
    return is_one;
}

Override parse_set(const std::string& argument) {
    const auto equals = argument.find('=');
    const auto key = argument.substr(0, equals);
    if (equals == std::string::npos || key.empty() || key.starts_with('.') || key.ends_with('.') ||
        key.find("..") != std::string::npos)
        throw bad_input("--set must be table.key=VALUE; it is \"{}\"", argument);
    if (const auto parts = 1 + std::count(key.begin(), key.end(), '.'); parts > max_parts)
        throw bad_input("--set needs a key of at most {} parts; this one has {}", max_parts, parts);
    return {key, argument.substr(equals + 1), "--set " + key};
}

std::string written(const toml::node& node) {
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    if (const auto* array = node.as_array()) {
        std::string text;
        for (const auto& element : *array) text += (text.empty() ? "" : ", ") + written(element);
        return fmt::format("[{}]", text);
    }
    if (const auto* table = node.as_table()) {
        std::string text;
        for (const auto& [key, value] : *table) {
            const bool is_bare =
                std::ranges::all_of(key.str(), [](unsigned char c) { return c == '_' || std::isalnum(c); });
            text += fmt::format("{}{} = {}", text.empty() ? "" : ", ",
                                is_bare ? std::string(key.str()) : written(toml::value(std::string(key.str()))),
                                written(value));
        }
        return fmt::format("{{ {} }}", text);
    }
    std::ostringstream out;
    node.visit([&](const auto& n) { out << toml::toml_formatter{n, toml::format_flags::none}; });
    return out.str();
}

std::string TomlText::literal_at(std::size_t line, std::size_t column) const {
    if (std::tie(line, column) < std::tie(last_.line, last_.column)) last_ = {};
    auto& [now, at, offset] = last_;
    while (std::tie(now, at) < std::tie(line, column) && offset < text_.size()) {
        const bool ends_line = text_[offset] == '\n';
        do ++offset;
        while (offset < text_.size() &&
               (static_cast<unsigned char>(text_[offset]) & 0xC0) == 0x80);  // continuation bytes of UTF-8
        now += ends_line ? 1 : 0;
        at = ends_line ? 1 : at + 1;
    }
    const auto rest = std::string_view(text_).substr(offset);
    std::string digits;
    for (const char byte : rest.substr(0, rest.find_first_not_of("0123456789+-._eE")))
        if (byte != '_') digits += byte;
    return digits;
}

std::optional<std::string> literal_of(const toml::node& node, const TomlTexts& texts) {
    const auto& [begin, end, path] = node.source();
    const auto text = path ? texts.find(*path) : texts.end();
    return text == texts.end() ? std::nullopt : std::optional(text->second.literal_at(begin.line, begin.column));
}

std::string kind_of(const toml::node& node) {
    // in the order of toml::node_type
    constexpr std::array<std::string_view, 7> kinds{"nothing",        "a table",          "an array", "a string",
                                                    "a whole number", "a decimal number", "a boolean"};
    const auto kind = static_cast<std::size_t>(node.type());
    return std::string(kind < kinds.size() ? kinds[kind] : "a date or time");
}

std::string shown(const toml::node& node) {
    auto text = written(node);
    std::replace(text.begin(), text.end(), '\n', ' ');
    constexpr std::size_t maximum = 60;
    return text.size() > maximum ? shortened(text, maximum - 1) : text;
}

std::string found(const toml::node& node) {
    return fmt::format("it is {} ({})", kind_of(node), shown(node));
}

}  // namespace doppel

#include "scene/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace doppel {
namespace {

constexpr std::string_view command_line = "--";

std::string kind_of(const toml::node& node) {
    switch (node.type()) {
        case toml::node_type::table: return "a table";
        case toml::node_type::array: return "an array";
        case toml::node_type::string: return "a string";
        case toml::node_type::integer:
        case toml::node_type::floating_point: return "a number";
        case toml::node_type::boolean: return "a boolean";
        default: return "a date or time";
    }
}

/// The value as TOML writes it, on one line and not too long.
std::string shown(const toml::node& node) {
    std::ostringstream out;
    node.visit([&](const auto& n) { out << toml::toml_formatter{n, toml::format_flags::none}; });
    std::string text = out.str();
    std::replace(text.begin(), text.end(), '\n', ' ');
    constexpr std::size_t most = 60;
    if (text.size() > most) text = text.substr(0, most - 1) + "…";
    return text;
}

std::string found(const toml::node& node) { return fmt::format("it is {} ({})", kind_of(node), shown(node)); }

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const auto swap = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({swap, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

std::string listed(std::span<const std::string_view> choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates) {
    const auto better = [&](auto a, auto b) { return edit_distance(word, a) < edit_distance(word, b); };
    const auto best = std::min_element(candidates.begin(), candidates.end(), better);
    if (best == candidates.end() || edit_distance(word, *best) > std::max<std::size_t>(2, word.size() / 3)) return {};
    return std::string(*best);
}

std::string place_of(const toml::table& table, std::string_view key, const std::string& path) {
    for (auto&& [name, node] : table) {
        if (name.str() != key) continue;
        const auto& origin = node.source().path;
        if (origin && origin->starts_with(command_line)) return *origin;
        return fmt::format("{}:{}:{}", path, name.source().begin.line, name.source().begin.column);
    }
    return path;
}

TomlReader::TomlReader(const toml::table* table, std::string name, std::string path)
    : table_(table), name_(std::move(name)), path_(std::move(path)) {}

std::string TomlReader::place(std::string_view key) const { return table_ ? place_of(*table_, key, path_) : path_; }

std::string TomlReader::subject(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{} {}", name_, key);
}

const toml::node* TomlReader::find(std::string_view key) {
    known_.emplace(key);
    return table_ ? table_->get(key) : nullptr;
}

bool TomlReader::has(std::string_view key) { return find(key) != nullptr; }

void TomlReader::read_text(std::string_view key, std::string& into) {
    const auto* node = find(key);
    if (!node) return;
    if (!node->is_string()) throw fault(key, "must be a string; {}", found(*node));
    into = node->as_string()->get();
}

void TomlReader::read_choice(std::string_view key, std::string& into, std::span<const std::string_view> choices) {
    const auto* node = find(key);
    if (!node) return;
    read_text(key, into);
    if (std::find(choices.begin(), choices.end(), into) != choices.end()) return;
    const auto meant = nearest(into, choices);
    throw fault(key, "must be {}; it is \"{}\"{}", listed(choices), into,
                meant ? fmt::format("; did you mean \"{}\"?", *meant) : "");
}

double TomlReader::number(std::string_view key, std::string_view element, const toml::node& node) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    const auto name = fmt::format("{}{}", key, element);
    if (!value) throw bad_input("{}: {} must be a number; {}", place(key), subject(name), found(node));
    if (!std::isfinite(*value)) throw bad_input("{}: {} must be finite; it is {}", place(key), subject(name), *value);
    return *value;
}

void TomlReader::read_number(std::string_view key, double& into) {
    if (const auto* node = find(key)) into = number(key, "", *node);
}

void TomlReader::read_positive(std::string_view key, double& into) {
    read_number(key, into);
    if (has(key) && !(into > 0)) throw fault(key, "must be > 0; it is {}", into);
}

void TomlReader::read_numbers(std::string_view key, std::span<double> into, std::string_view one_each) {
    const auto* node = find(key);
    if (!node) return;
    const auto* array = node->as_array();
    if (!array) throw fault(key, "must be an array of {} numbers, {}; {}", into.size(), one_each, found(*node));
    if (array->size() != into.size())
        throw fault(key, "must have {} numbers, {}; it has {}: {}", into.size(), one_each, array->size(), shown(*node));
    for (std::size_t i = 0; i < into.size(); ++i) into[i] = number(key, fmt::format("[{}]", i), *array->get(i));
}

void TomlReader::read_positives(std::string_view key, std::span<double> into, std::string_view one_each) {
    read_numbers(key, into, one_each);
    for (std::size_t i = 0; has(key) && i < into.size(); ++i)
        if (!(into[i] > 0)) throw bad_input("{}: {}[{}] must be > 0; it is {}", place(key), subject(key), i, into[i]);
}

void TomlReader::read_whole(std::string_view key, int& into, int least, int most) {
    const auto* node = find(key);
    if (!node) return;
    if (!node->is_integer()) throw fault(key, "must be a whole number; {}", found(*node));
    const auto value = node->as_integer()->get();
    if (value < least || value > most) throw fault(key, "must be from {} to {}; it is {}", least, most, value);
    into = static_cast<int>(value);
}

void TomlReader::read_positive_ratio(std::string_view key, Rational& into) {
    const auto* node = find(key);
    if (!node) return;
    std::optional<Rational> value;
    if (const auto* text = node->as_string()) {
        value = parse_rational(text->get());
        if (!value) throw fault(key, "must be a number or a fraction such as \"1/30000\"; it is {}", shown(*node));
    } else if (const auto* whole = node->as_integer()) {
        value = reduced(whole->get(), 1);
    } else {
        value = rational_from_decimal(number(key, "", *node));
    }
    if (!value) throw fault(key, "has more digits than Doppel counts with; it is {}", shown(*node));
    if (value->numerator <= 0) throw fault(key, "must be > 0; it is {}", shown(*node));
    into = *value;
}

std::optional<std::vector<std::string>> TomlReader::read_texts(std::string_view key) {
    const auto* node = find(key);
    if (!node) return std::nullopt;
    const auto* array = node->as_array();
    if (!array) throw fault(key, "must be an array of strings; {}", found(*node));
    std::vector<std::string> texts;
    for (const auto& element : *array) {
        if (!element.is_string()) throw fault(key, "must be an array of strings; {} is {}", shown(element), kind_of(element));
        texts.push_back(element.as_string()->get());
    }
    return texts;
}

const toml::table* TomlReader::read_table(std::string_view key) {
    const auto* node = find(key);
    if (node && !node->is_table()) throw fault(key, "must be a table; {}", found(*node));
    return node ? node->as_table() : nullptr;
}

void TomlReader::finish() const {
    if (!table_) return;
    for (auto&& [name, node] : *table_) {
        if (known_.contains(name.str())) continue;
        const std::vector<std::string_view> keys(known_.begin(), known_.end());
        const auto meant = nearest(name.str(), keys);
        throw bad_input("{}: {} no \"{}\"; {}", place(name.str()), name_.empty() ? "a preset has" : name_ + " has",
                        name.str(),
                        meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("it has {}", fmt::join(keys, ", ")));
    }
}

}  // namespace doppel

#include "scene/toml_reader.hpp"

#include "base/text.hpp"
#include "render/font.hpp"
#include "scene/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace doppel {
namespace {

constexpr std::string_view command_line = "--";

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

/// The value as TOML writes it, on one line and not too long.
std::string shown(const toml::node& node) {
    auto text = written(node);
    std::replace(text.begin(), text.end(), '\n', ' ');
    constexpr std::size_t most = 60;
    return text.size() > most ? text.substr(0, most - 1) + "…" : text;
}

std::string found(const toml::node& node) {
    return fmt::format("it is {} ({})", kind_of(node), shown(node));
}

std::string listed(std::span<const std::string_view> choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

/// What keeps a text from being drawn; nothing where the font has all of its letters.
std::optional<std::string> not_drawable(std::string_view text) {
    const auto lacking = lacking_character(text);
    if (lacking.empty()) return std::nullopt;
    auto rest = lacking;
    const auto character = next_character(rest);
    const auto number = fmt::format("U+{:04X}", static_cast<unsigned>(character));
    if (is_control(character)) return fmt::format("holds the control character {}, which cannot be drawn", number);
    return fmt::format(
        "holds \"{}\" ({}), which the built-in font lacks; it has Latin and Greek letters and signs of mathematics",
        lacking, number);
}

}  // namespace

TomlReader::TomlReader(const toml::table* table, std::string name, std::string path, const TomlTexts& texts)
    : table_(table), name_(std::move(name)), path_(std::move(path)), texts_(&texts) {}

std::string TomlReader::place(std::string_view key) const {
    if (!table_) return path_;
    for (auto&& [name, node] : *table_) {
        if (name.str() != key) continue;
        const auto& origin = node.source().path;
        if (origin && origin->starts_with(command_line)) return *origin;
        return fmt::format("{}:{}:{}", path_, name.source().begin.line, name.source().begin.column);
    }
    return path_;
}

std::string TomlReader::subject(std::string_view key) const {
    return name_.empty() ? std::string(key) : fmt::format("{} {}", name_, key);
}

const toml::node* TomlReader::find(std::string_view key) {
    known_.emplace(key);
    return table_ ? table_->get(key) : nullptr;
}

bool TomlReader::has(std::string_view key) {
    return find(key) != nullptr;
}

void TomlReader::read_text(std::string_view key, std::string& into) {
    const auto* node = find(key);
    if (!node) return;
    if (!node->is_string()) throw fault(key, "must be a string; {}", found(*node));
    into = node->as_string()->get();
}

void TomlReader::demand_drawable(std::string_view key, std::string_view text) const {
    if (const auto fault = not_drawable(text)) throw this->fault(key, "{}", *fault);
}

void TomlReader::read_drawn(std::string_view key, std::string& into) {
    read_text(key, into);
    demand_drawable(key, into);
}

void TomlReader::read_drawn_title(std::string& into) {
    constexpr std::string_view key = "title";
    if (!has(key))
        if (const auto fault = not_drawable(into))
            throw bad_input("{}: title is missing, and the preset's name in its place {}", path_, *fault);
    read_drawn(key, into);
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
    return *value + 0.0;  // −0 is 0
}

Quad TomlReader::exact(std::string_view key, std::string_view element, const toml::node& node) const {
    const double rounded = number(key, element, node);
    if (const auto* whole = node.as_integer()) return Quad(whole->get());
    const auto& origin = node.source().path;
    const auto text = texts_->find(origin ? *origin : path_);
    if (text == texts_->end()) return Quad(rounded);
    const auto& at = node.source().begin;
    const Quad value = parse_quad(text->second.literal_at(at.line, at.column)) + 0;
    // the literal found must be the number that was read, or its place was mistaken
    constexpr double rounding = 1e-15, least = 1e-322;
    if (!(std::abs(static_cast<double>(value) - rounded) <= rounding * std::abs(rounded) + least))
        throw bad_input("{}: the digits of {} cannot be found in the text; it is {}", place(key), subject(key),
                        rounded);
    return value;
}

void TomlReader::read_number(std::string_view key, Quad& into) {
    if (const auto* node = find(key)) into = exact(key, "", *node);
}

void TomlReader::read_positive(std::string_view key, Quad& into) {
    read_number(key, into);
    if (has(key) && !(into > 0)) throw fault(key, "must be > 0; it is {}", text_of(into));
}

void TomlReader::read_numbers(std::string_view key, std::span<Quad> into, std::string_view one_each) {
    const auto* node = find(key);
    if (!node) return;
    if (node->is_number()) {
        std::fill(into.begin(), into.end(), exact(key, "", *node));
        return;
    }
    const auto* array = node->as_array();
    if (!array)
        throw fault(key, "must be a number, or an array of {} numbers, {}; {}", into.size(), one_each, found(*node));
    if (array->size() != into.size())
        throw fault(key, "must have {} numbers, {}; it has {}: {}", into.size(), one_each, array->size(), shown(*node));
    for (std::size_t i = 0; i < into.size(); ++i) into[i] = exact(key, fmt::format("[{}]", i), *array->get(i));
}

void TomlReader::read_positives(std::string_view key, std::span<Quad> into, std::string_view one_each) {
    read_numbers(key, into, one_each);
    for (std::size_t i = 0; has(key) && i < into.size(); ++i)
        if (!(into[i] > 0))
            throw bad_input("{}: {}[{}] must be > 0; it is {}", place(key), subject(key), i, text_of(into[i]));
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

void TomlReader::read_positive_list(std::string_view key, std::vector<double>& into, std::size_t most) {
    const auto* node = find(key);
    if (!node) return;
    const auto* array = node->as_array();
    if (!array || array->empty() || array->size() > most)
        throw fault(key, "must be an array of 1 to {} numbers; {}", most, found(*node));
    into.resize(array->size());
    read_positives(key, into, "each on its own");
}

void TomlReader::read_whole(std::string_view key, int& into, int least, int most) {
    const auto* node = find(key);
    if (!node) return;
    if (!node->is_integer()) throw fault(key, "must be a whole number; {}", found(*node));
    const auto value = node->as_integer()->get();
    if (value < least || value > most) throw fault(key, "must be from {} to {}; it is {}", least, most, value);
    into = static_cast<int>(value);
}

void TomlReader::read_truth(std::string_view key, bool& into) {
    const auto* node = find(key);
    if (!node) return;
    if (!node->is_boolean()) throw fault(key, "must be true or false; {}", found(*node));
    into = node->as_boolean()->get();
}

std::optional<Rational> TomlReader::ratio(std::string_view key) {
    const auto* node = find(key);
    if (!node) return std::nullopt;
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
    return value;
}

void TomlReader::read_positive_ratio(std::string_view key, Rational& into) {
    const auto value = ratio(key);
    if (!value) return;
    if (value->numerator <= 0) throw fault(key, "must be > 0; it is {}", shown(*find(key)));
    into = *value;
}

void TomlReader::read_ratio_from_zero(std::string_view key, Rational& into) {
    const auto value = ratio(key);
    if (!value) return;
    if (value->numerator < 0) throw fault(key, "must be ≥ 0; it is {}", shown(*find(key)));
    into = *value;
}

void TomlReader::read_color(std::string_view key, Color& into) {
    const auto* node = find(key);
    if (!node) return;
    const auto* text = node->as_string();
    const auto color = text ? parse_color(text->get()) : std::nullopt;
    if (!color) throw fault(key, "must be a colour such as \"#ff9f40\"; {}", found(*node));
    into = *color;
}

std::optional<std::vector<std::string>> TomlReader::read_texts(std::string_view key) {
    const auto* node = find(key);
    if (!node) return std::nullopt;
    const auto* array = node->as_array();
    if (!array) throw fault(key, "must be an array of strings; {}", found(*node));
    std::vector<std::string> texts;
    for (const auto& element : *array) {
        if (!element.is_string())
            throw fault(key, "must be an array of strings; {} is {}", shown(element), kind_of(element));
        texts.push_back(element.as_string()->get());
    }
    return texts;
}

const toml::table* TomlReader::read_table(std::string_view key) {
    const auto* node = find(key);
    if (node && !node->is_table()) throw fault(key, "must be a table; {}", found(*node));
    return node ? node->as_table() : nullptr;
}

std::vector<const toml::table*> TomlReader::read_tables(std::string_view key) {
    std::vector<const toml::table*> tables;
    const auto* node = find(key);
    if (!node) return tables;
    const auto* array = node->as_array();
    if (!array || !array->is_array_of_tables())
        throw fault(key, "must be written as [[{}{}{}]] tables; {}", bare_name(), name_.empty() ? "" : ".", key,
                    found(*node));
    for (const auto& element : *array) tables.push_back(element.as_table());
    return tables;
}

void TomlReader::read_pair(std::string_view key, std::array<Quad, 2>& into) {
    const auto* node = find(key);
    if (node && !node->is_array()) throw fault(key, "must be two numbers, [x, y]; {}", found(*node));
    read_numbers(key, into, "x and y");
}

bool TomlReader::is_text(std::string_view key) {
    const auto* node = find(key);
    return node && node->is_string();
}

bool TomlReader::from_command_line(std::string_view key) {
    const auto* node = find(key);
    return node && node->source().path && node->source().path->starts_with(command_line);
}

void TomlReader::finish() const {
    if (!table_) return;
    for (auto&& [name, node] : *table_) {
        if (known_.contains(name.str())) continue;
        const std::vector<std::string_view> keys(known_.begin(), known_.end());
        const auto meant = nearest(name.str(), keys);
        throw bad_input(
            "{}: {} no \"{}\"; {}", place(name.str()), name_.empty() ? "a preset has" : name_ + " has", name.str(),
            meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("it has {}", fmt::join(keys, ", ")));
    }
}

}  // namespace doppel

#include "base/text.hpp"
#include "scene/resolved.hpp"
#include "scene/toml_reader.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

std::string listed(std::span<const std::string_view> choices) {
    std::string text;
    for (std::size_t i = 0; i < choices.size(); ++i)
        text += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ", choices[i]);
    return text;
}

/// Given on the command line: there, one number or text is a list of one.
bool is_typed(const toml::node& node) {
    const auto& origin = node.source().path;
    return origin && origin->starts_with("--");
}

/// Whether the file gives a hidden key, and the command line another value of what hides it: then that is no error.
bool is_ruled_out(const Field& field, const toml::table* table) {
    const auto* node = table ? table->get(field.key) : nullptr;
    if (!node || is_typed(*node)) return false;
    return std::any_of(table->begin(), table->end(), [&](const auto& entry) {
        return (field.only.beside.empty() || entry.first.str() == field.only.beside) && is_typed(entry.second);
    });
}

std::string index_text(std::initializer_list<std::size_t> element) {
    std::string text;
    for (const auto index : element) text += fmt::format("[{}]", index);
    return text;
}

}  // namespace

std::string significant_digits(std::string_view decimal) {
    std::string digits;
    for (const char c : decimal.substr(0, decimal.find_first_of("eE")))
        if (c >= '0' && c <= '9' && !(c == '0' && digits.empty())) digits += c;
    while (digits.ends_with('0')) digits.pop_back();
    return digits;
}

bool TomlReader::counts(const Field& field) {
    const auto& only = field.only;
    if (only.hides && !only.holds) {
        hidden_.emplace(field.key, only.beside);
        if (is_ruled_out(field, table_)) known_.emplace(field.key);
    }
    if (only.hides || only.holds || only.fault.empty()) return only.hides ? only.holds : true;
    if (has(field.key) && (!only.drops || from_command_line(field.key)))
        throw fault(field.key, "{}", only.fault).with(beside(only.beside));
    return false;
}

void TomlReader::demand(const Field& field, bool given) const {
    if (!given && !field.needed_by.empty())
        throw fault(field.key, "is missing; a {} needs it", field.needed_by).with(beside("kind"));
}

/// The fault as one of several keys, where beside others the key would take the number.
TomlFault TomlReader::faulty_number(const Field& field, double value, const TomlFault& fault) const {
    const auto& widest = field.otherwise;
    const bool is_possible = widest && value >= widest->low && value <= widest->high;
    return is_possible ? fault.with(beside(field.only.beside)) : fault;
}

template <class Number>
void TomlReader::check(const Field& field, Element element, const Number& value) const {
    const auto& [low, high, is_open, zero, reason, is_positive] = field.bounds;
    const std::string_view why = reason;  // clang 14 captures no structured binding
    if (is_open ? value > low : value >= low)
        if (value <= high) return;
    const auto refuse = [&](const std::string& what) {
        const auto message =
            fmt::format("{}: {}{} must be {}; {} is {}", place(field.key), subject(field.key),
                        why.empty() ? index_text(element) : "", what, why.empty() ? "it" : "one", toml_value(value));
        return faulty_number(field, static_cast<double>(value), {message, fault_place(field.key)});
    };
    // keys mostly name the unit
    const auto unit = field.unit.empty() || field.key.ends_with(field.unit) ? "" : fmt::format(" {}", field.unit);
    if (is_positive && !(value > 0)) throw refuse("> 0");
    if (is_open && !(value > low)) throw refuse(fmt::format("> {}", low));
    if (is_open) throw refuse(fmt::format("at most {}{}", high, unit));
    if (!field.bounds.has_high()) throw refuse(fmt::format("{} {}", is_positive ? "at least" : "≥", low));
    throw refuse(fmt::format("from {}{} to {}{}{}", low, zero.empty() ? "" : fmt::format(" ({})", zero), high, unit,
                             why.empty() ? "" : fmt::format(": {}", why)));
}

void TomlReader::read(const Field& field, const toml::node& node, std::string& into) {
    if (!node.is_string()) throw fault(field.key, "must be a string; {}", found(node));
    into = node.as_string()->get();
    if (field.is_drawn) demand_drawable(field.key, into);
    if (field.names.empty() || std::find(field.names.begin(), field.names.end(), into) != field.names.end()) return;
    const auto meant = nearest(into, field.names);
    throw fault(field.key, "must be {}; it is \"{}\"{}", listed(field.names), into,
                meant ? fmt::format("; did you mean \"{}\"?", *meant) : "");
}

void TomlReader::read(const Field& field, const toml::node& node, int& into) {
    if (!node.is_integer()) throw fault(field.key, "must be a whole number; {}", found(node));
    const auto value = node.as_integer()->get();
    if (static_cast<double>(value) < field.bounds.low || static_cast<double>(value) > field.bounds.high)
        throw faulty_number(
            field, static_cast<double>(value),
            fault(field.key, "must be from {} to {}; it is {}", field.bounds.low, field.bounds.high, value));
    into = static_cast<int>(value);
}

void TomlReader::read(const Field& field, const toml::node& node, bool& into) {
    if (!node.is_boolean()) throw fault(field.key, "must be true or false; {}", found(node));
    into = node.as_boolean()->get();
}

double TomlReader::number(std::string_view key, Element element, const toml::node& node, double) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (value && std::isfinite(*value)) return *value + 0.0;  // −0 is 0
    const auto name = subject(fmt::format("{}{}", key, index_text(element)));
    if (!value) throw bad_input("{}: {} must be a number; {}", place(key), name, found(node));
    throw bad_input("{}: {} must be finite; it is {}", place(key), name, *value);
}

Quad TomlReader::number(std::string_view key, Element element, const toml::node& node, const Quad&) const {
    const double rounded = number(key, element, node, 0.0);
    if (const auto* whole = node.as_integer()) return Quad(whole->get());
    const auto& origin = node.source().path;
    const auto text = texts_->find(origin ? *origin : path_);
    if (text == texts_->end()) return Quad(rounded);
    const auto& at = node.source().begin;
    const auto literal = text->second.literal_at(at.line, at.column);
    const Quad value = parse_quad(literal) + 0;
    // the literal found must be the number that was read, or its place was mistaken
    constexpr double rounding = 1e-15, least = 1e-322;
    if (!(std::abs(static_cast<double>(value) - rounded) <= rounding * std::abs(rounded) + least))
        throw bad_input("{}: the digits of {} cannot be found in the text; it is {}", place(key), subject(key),
                        rounded);
    constexpr std::size_t always_held = 33;
    if (literal.size() <= always_held) return value;
    const auto digits = significant_digits(literal);
    if (digits.size() > always_held && digits != significant_digits(text_of(value)))
        throw bad_input("{}: {} must have at most 34 digits, which quad holds; it has {}", place(key),
                        subject(fmt::format("{}{}", key, index_text(element))), digits.size());
    return value;
}

void TomlReader::read(const Field& field, const toml::node& node, double& into) {
    into = number(field.key, {}, node, into);
    check(field, {}, into);
}

void TomlReader::read(const Field& field, const toml::node& node, Quad& into) {
    into = number(field.key, {}, node, into);
    check(field, {}, into);
}

template <class Number>
void TomlReader::read_array(const Field& field, const toml::node& node, std::span<Number> into) {
    const auto& array = *node.as_array();
    if (array.size() != into.size())
        throw fault(field.key, "must have {} numbers, {}; it has {}: {}", into.size(), field.each, array.size(),
                    shown(node));
    for (std::size_t i = 0; i < into.size(); ++i) into[i] = number(field.key, {i}, *array.get(i), into[i]);
    for (std::size_t i = 0; i < into.size(); ++i) check(field, {i}, into[i]);
}

void TomlReader::read(const Field& field, const toml::node& node, std::span<double> into) {
    if (!node.is_array())
        throw fault(field.key, "must be an array of {} numbers, {}; {}", into.size(), field.each, found(node));
    read_array(field, node, into);
}

void TomlReader::read(const Field& field, const toml::node& node, std::vector<double>& into) {
    if (node.is_number() && is_typed(node)) {
        into.resize(1);
        return read(field, node, into[0]);
    }
    const auto* array = node.as_array();
    if (!array || array->empty() || array->size() > field.most)
        throw fault(field.key, "must be an array of 1 to {} numbers; {}", field.most, found(node));
    into.resize(array->size());
    read_array(field, node, std::span(into));
}

void TomlReader::read(const Field& field, const toml::node& node, Members& into) {
    into.angles_deg.clear();
    const auto* releases = node.as_array();
    if (!releases) return read(field, node, into.count);
    if (releases->size() < 2 || releases->size() > Members::most_releases)
        throw fault(field.key, "must be a whole number, or 2 to {} lists of angles; {}", Members::most_releases,
                    found(node));
    for (const auto& release : *releases) {
        auto& angles = into.angles_deg.emplace_back();
        const auto add = [&](const toml::node& angle) {
            const Element element{into.angles_deg.size() - 1, angles.size()};
            angles.push_back(number(field.key, element, angle, Quad()));
            check({.key = field.key, .bounds = {.low = -1e6, .high = 1e6}}, element, angles.back());
        };
        const auto* list = release.as_array();
        if (release.is_number() && is_typed(node))
            add(release);
        else if (!list || list->empty())
            throw fault(field.key, "must be a whole number, or 2 to {} lists of angles; {} is {}",
                        Members::most_releases, shown(release), kind_of(release));
        else
            for (const auto& angle : *list) add(angle);
    }
}

std::vector<std::string> TomlReader::texts_in(const Field& field, const toml::node& node) const {
    if (const auto* text = node.as_string(); text && is_typed(node)) return {text->get()};
    const auto* array = node.as_array();
    if (!array) throw fault(field.key, "must be an array of strings; {}", found(node));
    std::vector<std::string> texts;
    for (const auto& element : *array) {
        if (!element.is_string())
            throw fault(field.key, "must be an array of strings; {} is {}", shown(element), kind_of(element));
        texts.push_back(element.as_string()->get());
    }
    if (field.is_drawn && texts.size() > most_texts)
        throw fault(field.key, "must be at most {} texts; they are {}", most_texts, texts.size());
    return texts;
}

void TomlReader::read(const Field& field, const toml::node& node, std::vector<std::string>& into) {
    auto texts = texts_in(field, node);
    for (const auto& text : texts) {
        if (field.is_drawn) demand_drawable(field.key, text);
        if (!field.names.empty() && std::find(field.names.begin(), field.names.end(), text) == field.names.end())
            throw fault(field.key, "are of {}; \"{}\" is not", fmt::join(field.names, ", "), text);
    }
    into = std::move(texts);
}

void TomlReader::read(const Field& field, const toml::node& node, ChosenText& into) {
    into = {};
    if (node.is_boolean()) return read(field, node, into.shown);
    if (node.is_string()) return read(field, node, into.own.emplace().emplace_back());
    if (!node.is_array()) throw fault(field.key, "must be true, false, text or a list of text; {}", found(node));
    read(field, node, into.own.emplace());
}

void TomlReader::read(const Field& field, const toml::node& node, TomlValues& into) {
    const auto* array = node.as_array();
    if (!array || array->empty() || array->size() > field.most)
        throw fault(field.key, "must be an array of 1 to {} values; {}", field.most, found(node));
    into.texts.clear();
    for (const auto& element : *array)
        into.texts.push_back(element.is_number() ? text_of(number(field.key, {}, element, Quad())) : written(element));
}

void TomlReader::read(const Field& field, const toml::node& node, std::span<Quad> into) {
    if (node.is_array()) return read_array(field, node, into);
    if (!node.is_number())
        throw fault(field.key, "must be a number, or an array of {} numbers, {}; {}", into.size(), field.each,
                    found(node));
    std::fill(into.begin(), into.end(), number(field.key, {}, node, Quad()));
    check(field, {0}, into[0]);
}

/// As many numbers as there are already: other keys say how many.
void TomlReader::read(const Field& field, const toml::node& node, std::vector<Quad>& into) {
    const auto* array = node.as_array();
    const bool is_of_other_length = array && array->size() != into.size();
    try {
        read(field, node, std::span(into));
    } catch (const TomlFault& fault) {
        throw is_of_other_length ? fault.with(beside("links")) : fault;
    }
}

void TomlReader::read(const Field& field, const toml::node& node, QuadPair& into) {
    if (!node.is_array()) throw fault(field.key, "must be two numbers, [x, y]; {}", found(node));
    read_array({.key = field.key, .each = "x and y"}, node, std::span<Quad>(into));
}

void TomlReader::read(const Field& field, const toml::node& node, EndSpec& into) {
    if (node.is_string())
        read(field, node, into.emplace<std::string>());
    else
        read(field, node, into.emplace<QuadPair>());
}

void TomlReader::read_whole_pair(const Field& field, const toml::node& node, std::string_view what,
                                 std::array<int, 2>& into) {
    std::array<double, 2> pair{double(into[0]), double(into[1])};
    read({.key = field.key, .each = field.each}, node, std::span<double>(pair));
    for (const double number : pair)
        if (number != std::floor(number) || number < field.bounds.low || number > field.bounds.high)
            throw fault(field.key, "must be {} from {} to {}; it is [{}, {}]", what, field.bounds.low,
                        field.bounds.high, pair[0], pair[1]);
    into = {static_cast<int>(pair[0]), static_cast<int>(pair[1])};
}

void TomlReader::read(const Field& field, const toml::node& node, std::array<int, 2>& into) {
    read_whole_pair(field, node, "two whole numbers", into);
}

void TomlReader::read(const Field& field, const toml::node& node, Size& into) {
    std::array<int, 2> size{into.width, into.height};
    read_whole_pair(field, node, "whole numbers", size);
    into = {size[0], size[1]};
}

/// Bounds above 0: an axis by powers of ten.
void TomlReader::read(const Field& field, const toml::node& node, Range& into) {
    std::array<double, 2> ends{};
    read(field, node, std::span<double>(ends));
    if (field.bounds.is_open && (!(ends[1] >= 10 * ends[0]) || ends[1] / ends[0] > 1e60))
        throw fault(field.key, "must rise by 1 to 60 powers of ten; it is [{}, {}]", ends[0], ends[1]);
    if (!(ends[1] > ends[0]) || !std::isfinite(ends[1] - ends[0]))
        throw fault(field.key, "must rise; it is [{}, {}]", ends[0], ends[1]);
    into = {ends[0], ends[1]};
}

void TomlReader::read(const Field& field, const toml::node& node, Rational& into) {
    std::optional<Rational> value;
    if (const auto* text = node.as_string()) {
        value = parse_rational(text->get());
        if (!value) throw fault(field.key, "must be a number or a fraction such as \"1/30000\"; it is {}", shown(node));
    } else if (const auto* whole = node.as_integer()) {
        value = reduced(whole->get(), 1);
    } else {
        // of all digits that are written, or of none
        const Quad decimal = number(field.key, {}, node, Quad());
        value = rational_from_decimal(static_cast<double>(decimal));
        const Quad rounding = parse_quad("1e-32") * abs(decimal);
        if (value && abs(Quad(value->as<Quad>() - decimal)) > rounding) value.reset();
    }
    if (!value) throw fault(field.key, "has more digits than Doppel counts with; it is {}", shown(node));
    if (value->numerator < (field.bounds.is_open ? 1 : 0))
        throw fault(field.key, "must be {} 0; it is {}", field.bounds.is_open ? ">" : "≥", shown(node));
    check(field, {}, value->value());
    into = *value;
}

}  // namespace doppel

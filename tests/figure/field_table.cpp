#include "figure/field_table.hpp"

#include "scene/resolved.hpp"

#include <fmt/ranges.h>

namespace doppel::test {
namespace {

/// The description of each type of member; of those without one, a text.
template <class T>
constexpr ValueType value_type{"text", "\"\""};
template <class T>
constexpr ValueType value_type<std::optional<T>> = value_type<T>;
template <class T>
constexpr ValueType value_type<std::vector<T>>{"numbers", "1"};
template <>
constexpr ValueType value_type<bool>{"`true` or `false`", "true"};
template <>
constexpr ValueType value_type<int>{"whole number"};
template <>
constexpr ValueType value_type<double>{"number", "1", "1e-6"};
template <>
constexpr ValueType value_type<Quad> = value_type<double>;
template <>
constexpr ValueType value_type<Rational>{"number or \"a/b\"", "1", "60"};
template <>
constexpr ValueType value_type<std::vector<std::string>>{.words = "list of text", .example = "[\"\"]", .is_list = true};
template <>
constexpr ValueType value_type<Panels>{.words = "list of text, not empty", .is_list = true};
template <>
constexpr ValueType value_type<Speed>{"number, \"a/b\", or list of [s, number]"};
template <>
constexpr ValueType value_type<QuadPair>{"[x, y]", "[0, 0]"};
template <>
constexpr ValueType value_type<Members>{"whole number, or list of 2 to 8 pendulums"};
template <>
constexpr ValueType value_type<ChosenText>{"`true`, `false`, text or list of text"};
template <>
constexpr ValueType value_type<EndSpec>{"text or [x, y]", "\"\""};
template <>
constexpr ValueType value_type<TomlValues>{"values that the key takes", "[0, 90]"};
template <>
constexpr ValueType value_type<Size>{"two whole numbers", "[4, 3]"};
template <>
constexpr ValueType value_type<std::array<int, 2>> = value_type<Size>;
template <>
constexpr ValueType value_type<Range>{"two numbers", "[0, 10]", "[1e-6, 10]"};
template <>
constexpr ValueType value_type<Color>{"\"#rrggbb\"", "\"#ff9f40\""};
template <>
constexpr ValueType value_type<std::array<Color, 2>>{"two of \"#rrggbb\"", "[\"#ff9f40\", \"#4fc3f7\"]"};

}  // namespace

void FieldTable::key(const Field& field, const KeyMember& by_default) {
    const auto type = std::visit([]<class M>(const M&) { return value_type<std::remove_pointer_t<M>>; }, by_default);
    ListedField listed{field, by_default.index(), type, {}, {}};
    if (is_widest) listed.bounds = field.otherwise.value_or(field.bounds);
    if (const auto* choice = std::get_if<ChosenName>(&by_default)) listed.names = choice->names;
    listed.described_default = !field.needed_by.empty() ? must_be_given : field.absent.empty() ? "none" : field.absent;
    if (field.needed_by.empty() && field.absent.empty()) listed.default_value = toml_value(by_default);
    fields.push_back(std::move(listed));
}

void FieldTable::table(std::string_view key, const std::function<void(KeyVisitor&)>& list) {
    // "[system], [a], [b]": the first one
    list(tables.emplace_back(name.empty() ? fmt::format("[{}]", key)
                                          : fmt::format("[{}.{}]", name.substr(1, name.find(']') - 1), key)));
}

std::string ListedField::range_text() const {
    if (bounds.is_open) return bounds.has_high() ? fmt::format("> 0, to {}", bounds.high) : "> 0";
    if (!bounds.has_low()) return "";
    if (!bounds.has_high()) return fmt::format("≥ {}", bounds.low);
    return fmt::format("{}{} to {}", bounds.low, bounds.zero.empty() ? "" : fmt::format(" ({})", bounds.zero),
                       bounds.high);
}

std::string ListedField::takes() const {
    std::string text(type.words);
    if (!names.empty()) text = fmt::format("`\"{}\"`", fmt::join(names, "\"`, `\""));
    if (!names.empty() && type.is_list) text = "list of " + text;
    if (maximum > 0) text = fmt::format("1 to {} {}", maximum, text);
    if (const auto range = range_text(); !range.empty()) text += ", " + range;
    if (is_drawn && names.empty()) text += fmt::format(", at most {} letters", max_letters);
    return text;
}

std::string ListedField::example() const {
    if (!default_value.empty()) return default_value;
    // from "1e-12; in quad 1e-28"
    const auto first = described_default.substr(0, described_default.find_first_of("; "));
    const bool is_number = !first.empty() && first.find_first_not_of("0123456789.e-/") == std::string::npos;
    if (is_number) return fmt::format("{0}{1}{0}", first.find('/') == std::string::npos ? "" : "\"", first);
    if (!names.empty())
        return fmt::format("{}\"{}\"{}", type.is_list ? "[" : "", names.front(), type.is_list ? "]" : "");
    if (unit == "cm") return "8.6";  // width of a journal's column
    const auto example = bounds.is_open ? type.positive_example : type.example;
    return example.empty() ? fmt::format("{}", bounds.low) : std::string(example);
}

std::string_view FieldTable::key() const {
    const std::string_view inside = std::string_view(name).substr(0, name.find(']'));
    return inside.substr(inside.find_last_of("[.") + 1);
}

}  // namespace doppel::test

#include "scene/field_table.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace doppel {
namespace {

/// A JSON number, as an integer if it is whole.
Json json_number(double number) {
    constexpr double maximum = 1e15;
    if (number == std::floor(number) && std::abs(number) < maximum) return std::llround(number);
    return number;
}

Json within(const Bounds& bounds) {
    Json schema{{"type", "number"}};
    if (bounds.has_low() || bounds.is_positive) {
        schema["minimum"] = json_number(std::max(bounds.low, bounds.is_positive ? 0.0 : -Bounds::infinity));
        if (bounds.is_open) schema["exclusiveMinimum"] = true;
    }
    if (bounds.has_high()) schema["maximum"] = json_number(bounds.high);
    return schema;
}

/// A ratio is not negative, and its denominator is not 0.
Json ratio_within(Bounds bounds) {
    constexpr std::string_view exponent = R"(([eE]\+?-?[0-9]+)?)", any = R"(([0-9]+\.?[0-9]*|\.[0-9]+))",
                               not_0 = R"(([0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*))";
    const auto above = fmt::format("{}{}", bounds.is_open ? not_0 : any, exponent);
    const auto below = fmt::format("{}{}", not_0, exponent);
    if (!bounds.has_low()) bounds.low = 0;
    const auto pattern = fmt::format(R"(^(\+?{0}(/\+?{1})?|-{0}/-{1})$)", above, below);
    return {{"anyOf", {within(bounds), {{"type", "string"}, {"pattern", pattern}}}}};
}

Json text_schema(const ListedField& field) {
    Json schema{{"type", "string"}};
    if (!field.choices.empty()) schema["enum"] = field.choices;
    if (field.is_needed()) schema["minLength"] = 1;
    if (field.is_drawn) schema["maxLength"] = max_letters;
    if (!field.pattern.empty()) schema["pattern"] = field.pattern;
    return schema;
}

Json any_of(std::initializer_list<Json> schemas) {
    return {{"anyOf", Json(schemas)}};
}

using L = const ListedField&;

constexpr auto number_schema = [](L field) { return within(field.bounds); };
constexpr auto ratio_schema = [](L field) { return ratio_within(field.bounds); };
constexpr auto pair_schema = [](L field) { return list_schema(within(field.bounds), 2, 2); };
constexpr auto truth_schema = [](L) { return Json{{"type", "boolean"}}; };
constexpr auto color_schema = [](L) { return Json{{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}}; };
template <int minimum>
constexpr auto texts_schema =
    [](L field) { return list_schema(text_schema(field), minimum, field.is_drawn ? max_texts : 0); };

Json whole_schema(L field) {
    auto schema = within(field.bounds);
    schema["type"] = "integer";
    return schema;
}

Json numbers_schema(L field) {
    const auto number = within(field.bounds);
    return field.maximum > 0 ? list_schema(number, 1, field.maximum) : any_of({number, list_schema(number, 1, 0)});
}

Json whole_pair_schema(L field) {
    auto whole = within(field.bounds);
    whole["multipleOf"] = 1;
    return list_schema(whole, 2, 2);
}

Json speed_schema(L field) {
    const Json places{ratio_within(not_negative), ratio_within(changing_speeds)};
    const Json change{{"type", "array"}, {"items", places}, {"minItems", 2}, {"additionalItems", false}};
    return any_of({ratio_within(field.bounds), list_schema(change, 1, 0)});
}

Json members_schema(L field) {
    return any_of({whole_schema(field), list_schema(any_of({list_schema(within({}), 1, 0), Json{{"type", "object"}}}),
                                                    2, Members::max_releases)});
}

template <class T>
constexpr ValueType type_of() {
    using std::is_same_v;
    if constexpr (is_optional<T>) return type_of<typename T::value_type>();
    if constexpr (is_same_v<T, bool>) return {"`true` or `false`", truth_schema, "true"};
    if constexpr (is_same_v<T, int>) return {"whole number", whole_schema};
    if constexpr (is_same_v<T, double> || is_same_v<T, Quad>) return {"number", number_schema, "1", "1e-6"};
    if constexpr (is_same_v<T, Rational>) return {"number or \"a/b\"", ratio_schema, "1", "60"};
    if constexpr (is_same_v<T, std::vector<double>> || is_same_v<T, std::vector<Quad>>)
        return {"numbers", numbers_schema, "1"};
    if constexpr (is_same_v<T, std::vector<std::string>>)
        return {.words = "list of text", .schema = texts_schema<0>, .example = "[\"\"]", .is_list = true};
    if constexpr (is_same_v<T, Panels>)
        return {.words = "list of text, not empty", .schema = texts_schema<1>, .is_list = true};
    if constexpr (is_same_v<T, Speed>) return {"number, \"a/b\", or list of [s, number]", speed_schema};
    if constexpr (is_same_v<T, QuadPair>) return {"[x, y]", pair_schema, "[0, 0]"};
    if constexpr (is_same_v<T, Members>) return {"whole number, or list of 2 to 8 pendulums", members_schema};
    if constexpr (is_same_v<T, ChosenText>)
        return {"`true`, `false`, text or list of text", [](L field) {
                    return any_of({truth_schema(field), text_schema(field), texts_schema<0>(field)});
                }};
    if constexpr (is_same_v<T, EndSpec>)
        return {"text or [x, y]", [](L field) { return any_of({text_schema(field), pair_schema(field)}); }, "\"\""};
    if constexpr (is_same_v<T, TomlValues>)
        return {"values that the key takes", [](L field) { return list_schema(Json::object(), 1, field.maximum); },
                "[0, 90]"};
    if constexpr (is_same_v<T, Size> || is_same_v<T, std::array<int, 2>>)
        return {"two whole numbers", whole_pair_schema, "[4, 3]"};
    if constexpr (is_same_v<T, Range>) return {"two numbers", pair_schema, "[0, 10]", "[1e-6, 10]"};
    if constexpr (is_same_v<T, Color>) return {"\"#rrggbb\"", color_schema, "\"#ff9f40\""};
    if constexpr (is_same_v<T, std::array<Color, 2>>)
        return {"two of \"#rrggbb\"", [](L field) { return list_schema(color_schema(field), 2, 2); },
                "[\"#ff9f40\", \"#4fc3f7\"]"};
    return {"text", text_schema, "\"\""};
}

}  // namespace

Json list_schema(Json items, std::size_t minimum, std::size_t maximum) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (minimum > 0) schema["minItems"] = minimum;
    if (maximum > 0) schema["maxItems"] = maximum;
    return schema;
}

ValueType value_type(const KeyMember& member) {
    return std::visit([]<class M>(const M&) { return type_of<std::remove_pointer_t<M>>(); }, member);
}

}  // namespace doppel

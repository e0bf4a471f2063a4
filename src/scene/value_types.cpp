#include "scene/field_table.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace doppel {
namespace {

/// A number of JSON: whole where it is.
Json json_number(double number) {
    constexpr double most = 1e15;
    if (number == std::floor(number) && std::abs(number) < most) return std::llround(number);
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

/// A ratio is not negative, and nothing is divided by 0.
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
    if (field.is_drawn) schema["maxLength"] = most_letters;
    if (!field.pattern.empty()) schema["pattern"] = field.pattern;
    return schema;
}

Json any_of(std::initializer_list<Json> schemas) {
    return {{"anyOf", Json(schemas)}};
}

}  // namespace

Json list_schema(Json items, std::size_t least, std::size_t most) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (least > 0) schema["minItems"] = least;
    if (most > 0) schema["maxItems"] = most;
    return schema;
}

Json schema_of(const ListedField& field) {
    const auto number = within(field.bounds);
    const Json truth{{"type", "boolean"}}, color{{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}};
    auto whole = number;
    whole["type"] = "integer";
    const auto texts = [&](std::size_t least) {
        return list_schema(text_schema(field), least, field.is_drawn ? most_texts : 0);
    };
    switch (field.type.takes) {
        case Takes::truth:
            return truth;
        case Takes::whole:
            return whole;
        case Takes::number:
            return number;
        case Takes::ratio:
            return ratio_within(field.bounds);
        case Takes::numbers:
            return field.most > 0 ? list_schema(number, 1, field.most) : any_of({number, list_schema(number, 1, 0)});
        case Takes::pair:
            return list_schema(number, 2, 2);
        case Takes::whole_pair:
            whole = number;
            whole["multipleOf"] = 1;
            return list_schema(whole, 2, 2);
        case Takes::text:
            return text_schema(field);
        case Takes::texts:
            return texts(0);
        case Takes::some_texts:
            return texts(1);
        case Takes::chosen_text:
            return any_of({truth, text_schema(field), texts(0)});
        case Takes::end:
            return any_of({text_schema(field), list_schema(number, 2, 2)});
        case Takes::color:
            return color;
        case Takes::colors:
            return list_schema(color, 2, 2);
        case Takes::speed: {
            const Json places{ratio_within(not_negative), ratio_within(changing_speeds)};
            const Json change{{"type", "array"}, {"items", places}, {"minItems", 2}, {"additionalItems", false}};
            return any_of({ratio_within(field.bounds), list_schema(change, 1, 0)});
        }
        case Takes::members:
            return any_of({whole, list_schema(list_schema(within({}), 1, 0), 2, Members::most_releases)});
        case Takes::values:
            return list_schema(Json::object(), 1, field.most);
    }
    return {};
}

namespace {

template <class T>
constexpr ValueType type_of() {
    using std::is_same_v;
    if constexpr (is_optional<T>) return type_of<typename T::value_type>();
    if constexpr (is_same_v<T, bool>) return {Takes::truth, "`true` or `false`", "true"};
    if constexpr (is_same_v<T, int>) return {Takes::whole, "whole number", "1"};
    if constexpr (is_same_v<T, double> || is_same_v<T, Quad>) return {Takes::number, "number", "1", "1e-6"};
    if constexpr (is_same_v<T, Rational>) return {Takes::ratio, "number or \"a/b\"", "1", "60"};
    if constexpr (is_same_v<T, std::vector<double>> || is_same_v<T, std::vector<Quad>>)
        return {Takes::numbers, "numbers", "1"};
    if constexpr (is_same_v<T, std::vector<std::string>>) return {Takes::texts, "list of text", "[\"\"]"};
    if constexpr (is_same_v<T, Panels>) return {Takes::some_texts, "list of text, not empty"};
    if constexpr (is_same_v<T, Speed>) return {Takes::speed, "number, \"a/b\", or list of [s, number]"};
    if constexpr (is_same_v<T, QuadPair>) return {Takes::pair, "[x, y]", "[0, 0]"};
    if constexpr (is_same_v<T, Members>) return {Takes::members, "whole number, or angles of 2 to 8 pendulums"};
    if constexpr (is_same_v<T, ChosenText>) return {Takes::chosen_text, "`true`, `false`, text or list of text"};
    if constexpr (is_same_v<T, EndSpec>) return {Takes::end, "text or [x, y]", "\"\""};
    if constexpr (is_same_v<T, TomlValues>) return {Takes::values, "values that the key takes", "[0, 90]"};
    if constexpr (is_same_v<T, Size> || is_same_v<T, std::array<int, 2>>)
        return {Takes::whole_pair, "two whole numbers", "[4, 3]"};
    if constexpr (is_same_v<T, Range>) return {Takes::pair, "two numbers", "[0, 10]", "[1e-6, 10]"};
    if constexpr (is_same_v<T, Color>) return {Takes::color, "\"#rrggbb\"", "\"#ff9f40\""};
    if constexpr (is_same_v<T, std::array<Color, 2>>)
        return {Takes::colors, "two of \"#rrggbb\"", "[\"#ff9f40\", \"#4fc3f7\"]"};
    return {Takes::text, "text", "\"\""};
}

}  // namespace

ValueType value_type(const KeyMember& member) {
    return std::visit([]<class M>(const M&) { return type_of<std::remove_pointer_t<M>>(); }, member);
}

}  // namespace doppel

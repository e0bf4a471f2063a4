#include "scene/field_table.hpp"

#include <algorithm>
#include <cmath>

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

std::size_t texts_of(const ListedField& field) {
    return field.is_drawn ? most_texts : 0;
}

}  // namespace

Json list_schema(Json items, std::size_t least, std::size_t most) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (least > 0) schema["minItems"] = least;
    if (most > 0) schema["maxItems"] = most;
    return schema;
}

Json truth_schema(const ListedField& /*field*/) {
    return {{"type", "boolean"}};
}

Json number_schema(const ListedField& field) {
    return within(field.bounds);
}

Json integer_schema(const ListedField& field) {
    auto schema = within(field.bounds);
    schema["type"] = "integer";
    return schema;
}

Json ratio_schema(const ListedField& field) {
    return ratio_within(field.bounds);
}

Json numbers_schema(const ListedField& field) {
    const auto number = within(field.bounds);
    if (field.most > 0) return list_schema(number, 1, field.most);
    return {{"anyOf", {number, list_schema(number, 1, 0)}}};
}

Json pair_schema(const ListedField& field) {
    return list_schema(within(field.bounds), 2, 2);
}

Json whole_pair_schema(const ListedField& field) {
    auto whole = within(field.bounds);
    whole["multipleOf"] = 1;
    return list_schema(whole, 2, 2);
}

Json text_schema(const ListedField& field) {
    Json schema{{"type", "string"}};
    if (!field.choices.empty()) schema["enum"] = field.choices;
    if (field.is_needed()) schema["minLength"] = 1;
    if (field.is_drawn) schema["maxLength"] = most_letters;
    if (!field.pattern.empty()) schema["pattern"] = field.pattern;
    return schema;
}

Json texts_schema(const ListedField& field) {
    return list_schema(text_schema(field), 0, texts_of(field));
}

Json some_texts_schema(const ListedField& field) {
    return list_schema(text_schema(field), 1, texts_of(field));
}

Json chosen_text_schema(const ListedField& field) {
    return {{"anyOf", {truth_schema(field), text_schema(field), texts_schema(field)}}};
}

Json end_schema(const ListedField& field) {
    return {{"anyOf", {text_schema(field), pair_schema(field)}}};
}

Json color_schema(const ListedField& /*field*/) {
    return {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}};
}

Json colors_schema(const ListedField& field) {
    return list_schema(color_schema(field), 2, 2);
}

Json speed_schema(const ListedField& field) {
    const Json places{ratio_within(not_negative), ratio_within(changing_speeds)};
    const Json change{{"type", "array"}, {"items", places}, {"minItems", 2}, {"additionalItems", false}};
    return {{"anyOf", {ratio_within(field.bounds), list_schema(change, 1, 0)}}};
}

Json members_schema(const ListedField& field) {
    const auto release = list_schema(within({}), 1, 0);
    return {{"anyOf", {integer_schema(field), list_schema(release, 2, Members::most_releases)}}};
}

Json values_schema(const ListedField& field) {
    return list_schema(Json::object(), 1, field.most);
}

}  // namespace doppel

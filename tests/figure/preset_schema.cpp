#include "figure/preset_schema.hpp"

#include "figure/film_tables.hpp"
#include "figure/kind_tables.hpp"
#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace doppel::test {
namespace {

/// A list of `minimum` to `maximum` items; 0 = any number.
Json list_schema(Json items, std::size_t minimum, std::size_t maximum) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (minimum > 0) schema["minItems"] = minimum;
    if (maximum > 0) schema["maxItems"] = maximum;
    return schema;
}

/// A JSON number, as an integer if it is whole.
Json json_number(double number) {
    constexpr double maximum = 1e15;
    if (number == std::floor(number) && std::abs(number) < maximum) return std::llround(number);
    return number;
}

Json within(const Bounds& bounds) {
    Json schema{{"type", "number"}};
    if (bounds.has_low()) {
        schema["minimum"] = json_number(bounds.low);
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
    if (!field.names.empty()) schema["enum"] = field.names;
    if (is_needed(field)) schema["minLength"] = 1;
    if (field.is_drawn) schema["maxLength"] = max_letters;
    if (!field.pattern.empty()) schema["pattern"] = field.pattern;
    return schema;
}

Json any_of(std::initializer_list<Json> schemas) {
    return {{"anyOf", Json(schemas)}};
}

using L = const ListedField&;

Json pair_schema(L field) {
    return list_schema(within(field.bounds), 2, 2);
}
Json truth_schema() {
    return {{"type", "boolean"}};
}
Json color_schema() {
    return {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}};
}
Json texts_schema(L field, std::size_t minimum) {
    return any_of({text_schema(field), list_schema(text_schema(field), minimum, field.is_drawn ? max_texts : 0)});
}

Json whole_schema(L field) {
    auto schema = within(field.bounds);
    schema["type"] = "integer";
    return schema;
}

Json numbers_schema(L field) {
    const auto number = within(field.bounds);
    return any_of({number, list_schema(number, 1, field.maximum)});
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
    const auto release = any_of({within({}), list_schema(within({}), 1, 0), Json{{"type", "object"}}});
    return any_of({whole_schema(field), list_schema(release, 2, Members::max_releases)});
}

/// The schema of a key whose member has this type.
template <class T>
Json type_schema(L field) {
    using std::is_same_v;
    if constexpr (is_optional<T>) return type_schema<typename T::value_type>(field);
    if constexpr (is_same_v<T, bool>) return truth_schema();
    if constexpr (is_same_v<T, int>) return whole_schema(field);
    if constexpr (is_same_v<T, double> || is_same_v<T, Quad>) return within(field.bounds);
    if constexpr (is_same_v<T, Rational>) return ratio_within(field.bounds);
    if constexpr (is_same_v<T, std::vector<double>> || is_same_v<T, std::vector<Quad>>) return numbers_schema(field);
    if constexpr (is_same_v<T, std::vector<std::string>>) return texts_schema(field, 0);
    if constexpr (is_same_v<T, Panels>) return texts_schema(field, 1);
    if constexpr (is_same_v<T, Speed>) return speed_schema(field);
    if constexpr (is_same_v<T, QuadPair> || is_same_v<T, Range>) return pair_schema(field);
    if constexpr (is_same_v<T, Members>) return members_schema(field);
    if constexpr (is_same_v<T, ChosenText>) return any_of({truth_schema(), texts_schema(field, 0)});
    if constexpr (is_same_v<T, EndSpec>) return any_of({text_schema(field), pair_schema(field)});
    if constexpr (is_same_v<T, TomlValues>) return list_schema(Json::object(), 1, field.maximum);
    if constexpr (is_same_v<T, Size> || is_same_v<T, std::array<int, 2>>) return whole_pair_schema(field);
    if constexpr (is_same_v<T, Color>) return color_schema();
    if constexpr (is_same_v<T, std::array<Color, 2>>) return list_schema(color_schema(), 2, 2);
    return text_schema(field);
}

/// type_schema() of the type with this index.
template <class... Member>
Json type_schema(L field, const std::variant<Member...>*) {
    constexpr std::array<Json (*)(L), sizeof...(Member)> of_types{type_schema<std::remove_pointer_t<Member>>...};
    return of_types[field.member_type](field);
}

/// For example "a whole number of samples. Unit: s. Range: > 0. Default: 30."
std::string description_of(const ListedField& field) {
    auto text = fmt::format("{}.", field.help);
    if (!field.unit.empty()) text += fmt::format(" Unit: {}.", field.unit);
    if (const auto range = field.range_text(); !range.empty()) text += fmt::format(" Range: {}.", range);
    return text + (is_needed(field) ? " Must be given." : fmt::format(" Default: {}.", default_of(field)));
}

Json key_schema(const ListedField& field) {
    auto schema = type_schema(field, static_cast<const KeyMember*>(nullptr));
    schema["title"] = field.unit.empty() ? std::string(field.key) : fmt::format("{}, {}", field.key, field.unit);
    schema["description"] = description_of(field);
    if (!field.default_value.empty()) schema["default"] = json_of_toml("value = " + field.default_value)["value"];
    return schema;
}

Json table_schema(const FieldTable& table) {
    Json properties = Json::object();
    for (const auto& field : table.fields) properties[std::string(field.key)] = key_schema(field);
    for (const auto& inner : table.tables) properties[std::string(inner.key())] = table_schema(inner);
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
}

Json reference(std::string_view definition) {
    return {{"$ref", fmt::format("#/definitions/{}", definition)}};
}

Json needed_keys(const FieldTable& table) {
    Json keys = Json::array();
    for (const auto& field : table.fields)
        if (is_needed(field)) keys.push_back(field.key);
    return keys;
}

/// "rod" from "[[system.constraint]] kind = "rod"".
std::string part_kind(const FieldTable& table) {
    const auto quote = table.name.find('"');
    return table.name.substr(quote + 1, table.name.rfind('"') - quote - 1);
}

/// An object with these keys of any type.
Json with_keys(const FieldTable& table) {
    Json keys = Json::object();
    for (const auto& field : table.fields) keys[std::string(field.key)] = Json::object();
    for (const auto& inner : table.tables) keys[std::string(inner.key())] = Json::object();
    return {{"properties", std::move(keys)}, {"additionalProperties", false}};
}

/// An entry of [[system.constraint]] or [[system.force]]: the types of its keys, then the keys of each kind. An entry
/// with the name of an earlier one changes that one, and may have fewer keys.
Json entry_schema(const std::vector<FieldTable>& film, std::string_view key, bool may_change) {
    Json properties = Json::object(), names = Json::array(), kinds = Json::array();
    for (const auto& table : film) {
        if (!table.name.starts_with(fmt::format("[[system.{}]]", key))) continue;
        const auto name = part_kind(table);
        auto kind = with_keys(table);
        kind["title"] = name;
        kind["properties"]["kind"] = {{"enum", {name}}};
        auto needed = needed_keys(table);
        needed.push_back("kind");
        if (may_change)
            kind["anyOf"] = {{{"required", {"name"}}}, {{"required", needed}}};
        else
            kind["required"] = needed;
        kinds.push_back(std::move(kind));
        names.push_back(name);
        for (const auto& field : table.fields)
            if (const std::string known(field.key); !properties.contains(known)) properties[known] = key_schema(field);
    }
    properties["kind"] = {{"title", "kind"}, {"type", "string"}, {"enum", std::move(names)}};
    return {{"type", "object"},
            {"additionalProperties", false},
            {"properties", std::move(properties)},
            {"anyOf", std::move(kinds)}};
}

/// [system], or [a] and [b], which change [system].
Json side_schema(const std::vector<FieldTable>& film, bool may_change) {
    auto table = film[2];
    SideSpec side;
    if (may_change) side_text_fields(table, side);
    auto schema = table_schema(table);
    auto particle = table_schema(film[3]);
    particle["required"] = needed_keys(film[3]);
    schema["properties"]["particle"] = list_schema(particle, 0, 0);
    for (const auto& entries : film)
        if (entries.name == torque_table) schema["properties"]["torque"] = list_schema(table_schema(entries), 0, 0);
    for (const auto* key : {"constraint", "force"})
        schema["properties"][key] = list_schema(entry_schema(film, key, may_change), 0, 0);
    return schema;
}

/// [[curve]]: its keys, and sides on top of the preset's.
Json entries_schema(const FieldTable& table) {
    auto entry = table_schema(table);
    entry["required"] = needed_keys(table);
    for (const auto* side : {"system", "a", "b"}) entry["properties"][side] = reference("side");
    return list_schema(entry, 0, 0);
}

/// The tables that a preset of this kind may have, and the keys of tables that differ between kinds. The types of keys
/// are described elsewhere.
Json kind_schema(std::string_view kind) {
    Json tables = Json::object();
    for (const auto& table : tables_of(kind)) {
        auto keys = with_keys(table);
        const bool is_side = table.key() == "a" || table.key() == "b";
        for (const auto* entries : {"particle", "torque", "constraint", "force"})
            if (is_side) keys["properties"][entries] = Json::object();
        if (table.name == "[system]" && !table.tables.empty()) keys["properties"]["torque"] = Json::object();
        const bool differs = is_side || table.key() == "scene" || table.key() == "chart" ||
                             (table.key() == "system" && table.name == "[system]");
        if (table.key().empty())
            tables.update(keys["properties"]);
        else if (!differs)
            tables[std::string(table.key())] = Json::object();
        else
            tables[std::string(table.key())] = keys;
    }
    if (tables.contains("a")) tables["system"] = Json::object();
    tables["scene"]["properties"]["kind"] = {{"enum", {kind}}};
    Json schema{{"title", kind}, {"properties", std::move(tables)}, {"additionalProperties", false}};
    if (kind == pair_kind) return schema;
    schema["required"] = {"scene"};
    schema["properties"]["scene"]["required"] = {"kind"};
    return schema;
}

}  // namespace

std::string preset_schema() {
    const auto film = film_tables();
    Json properties = Json::object(), kinds = Json::array();
    for (const auto kind : scene_kinds) {
        kinds.push_back(kind_schema(kind));
        for (const auto& table : tables_of(kind)) {
            const auto schema = table.is_entry() ? entries_schema(table) : table_schema(table);
            if (table.key().empty())
                properties.update(schema["properties"]);
            else if (auto& known = properties[std::string(table.key())]; known.is_null())
                known = schema;
            else  // the keys of another kind for the same table: those of [chart] and [system] differ
                for (const auto& [key, value] : schema["properties"].items())
                    if (!known["properties"].contains(key)) known["properties"][key] = value;
        }
    }
    properties["system"] = reference("system");
    properties["a"] = properties["b"] = reference("side");
    const Json schema{{"$schema", "http://json-schema.org/draft-04/schema#"},
                      {"title", "Preset of Doppel"},
                      {"description", "A film of two pendulums, or a figure: docs/presets.md."},
                      {"type", "object"},
                      {"additionalProperties", false},
                      {"properties", std::move(properties)},
                      {"anyOf", std::move(kinds)},
                      {"definitions", {{"system", side_schema(film, false)}, {"side", side_schema(film, true)}}}};
    return schema.dump(2) + "\n";
}

}  // namespace doppel::test

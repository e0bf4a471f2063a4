#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace doppel {
namespace {

/// A number of JSON: whole where it is.
Json json_number(double number) {
    constexpr double most = 1e15;
    if (number == std::floor(number) && std::abs(number) < most) return std::llround(number);
    return number;
}

Json number_schema(const Bounds& bounds) {
    Json schema{{"type", "number"}};
    if (bounds.has_low() || bounds.is_positive) {
        schema["minimum"] = json_number(std::max(bounds.low, bounds.is_positive ? 0.0 : -Bounds::infinity));
        if (bounds.is_open) schema["exclusiveMinimum"] = true;
    }
    if (bounds.has_high()) schema["maximum"] = json_number(bounds.high);
    return schema;
}

Json list_schema(Json items, std::size_t least, std::size_t most) {
    Json schema{{"type", "array"}, {"items", std::move(items)}};
    if (least > 0) schema["minItems"] = least;
    if (most > 0) schema["maxItems"] = most;
    return schema;
}

Json text_schema(const ListedField& field) {
    Json schema{{"type", "string"}};
    if (!field.choices.empty()) schema["enum"] = field.choices;
    if (field.is_needed()) schema["minLength"] = 1;
    if (field.is_drawn) schema["maxLength"] = most_letters;
    if (!field.pattern.empty()) schema["pattern"] = field.pattern;
    return schema;
}

/// A ratio is not negative, and nothing is divided by 0.
Json ratio_schema(Bounds bounds) {
    constexpr std::string_view exponent = R"(([eE]\+?-?[0-9]+)?)", any = R"(([0-9]+\.?[0-9]*|\.[0-9]+))",
                               not_0 = R"(([0-9]*[1-9][0-9]*\.?[0-9]*|[0-9]*\.[0-9]*[1-9][0-9]*))";
    const auto above = fmt::format("{}{}", bounds.is_open ? not_0 : any, exponent);
    const auto below = fmt::format("{}{}", not_0, exponent);
    if (!bounds.has_low()) bounds.low = 0;
    const auto pattern = fmt::format(R"(^(\+?{0}(/\+?{1})?|-{0}/-{1})$)", above, below);
    return {{"anyOf", {number_schema(bounds), {{"type", "string"}, {"pattern", pattern}}}}};
}

/// What the reader of a key takes (scene/toml_reader.hpp), by type_words().
Json value_schema(const ListedField& field) {
    const auto number = number_schema(field.bounds);
    auto whole = number;
    whole["multipleOf"] = 1;
    const Json color{{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}};
    const auto pair = list_schema(number, 2, 2);
    const auto is = [&](std::string_view words) { return field.type == words; };
    if (is(type_words<bool>())) return {{"type", "boolean"}};
    if (is(type_words<double>())) return number;
    if (is(type_words<Rational>())) return ratio_schema(field.bounds);
    if (is(type_words<Speed>())) {
        const Json places{ratio_schema(not_negative), ratio_schema(changing_speeds)};
        const Json change{{"type", "array"}, {"items", places}, {"minItems", 2}, {"additionalItems", false}};
        return {{"anyOf", {ratio_schema(field.bounds), list_schema(change, 1, 0)}}};
    }
    if (is(type_words<std::vector<double>>()))
        return field.most > 0 ? list_schema(number, 1, field.most)
                              : Json{{"anyOf", {number, list_schema(number, 1, 0)}}};
    const std::size_t texts = field.is_drawn ? most_texts : 0;
    if (field.is_list()) return list_schema(text_schema(field), is(type_words<Panels>()) ? 1 : 0, texts);
    if (is(type_words<QuadPair>()) || is(type_words<Range>())) return pair;
    if (is(type_words<ChosenText>()))
        return {{"anyOf", {{{"type", "boolean"}}, text_schema(field), list_schema(text_schema(field), 0, texts)}}};
    if (is(type_words<TomlValues>())) return list_schema(Json::object(), 1, field.most);
    if (is(type_words<EndSpec>())) return {{"anyOf", {text_schema(field), pair}}};
    if (is(type_words<Size>())) return list_schema(whole, 2, 2);
    if (is(type_words<Color>())) return color;
    if (is(type_words<std::array<Color, 2>>())) return list_schema(color, 2, 2);
    if (is(type_words<std::string>())) return text_schema(field);
    auto integer = number;
    integer["type"] = "integer";
    if (is(type_words<Members>())) {
        const auto release = list_schema(number_schema({}), 1, 0);
        return {{"anyOf", {integer, list_schema(release, 2, Members::most_releases)}}};
    }
    if (!is(type_words<int>())) throw std::logic_error(fmt::format("no schema of \"{}\"", field.type));
    return integer;
}

/// "a whole number of samples. Unit: s. Range: > 0. Default: 30."
std::string description_of(const ListedField& field) {
    auto text = fmt::format("{}.", field.help);
    if (!field.unit.empty()) text += fmt::format(" Unit: {}.", field.unit);
    if (const auto range = field.range_text(); !range.empty()) text += fmt::format(" Range: {}.", range);
    return text + (field.is_needed() ? " Must be given." : fmt::format(" Default: {}.", field.by_default));
}

Json key_schema(const ListedField& field) {
    auto schema = value_schema(field);
    schema["title"] = field.unit.empty() ? std::string(field.key) : fmt::format("{}, {}", field.key, field.unit);
    schema["description"] = description_of(field);
    if (const auto value = field.default_value(); !value.empty())
        schema["default"] = json_of_toml("value = " + value)["value"];
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
        if (field.is_needed()) keys.push_back(field.key);
    return keys;
}

/// "rod" of "[[system.constraint]] kind = "rod"".
std::string part_kind(const FieldTable& table) {
    const auto quote = table.name.find('"');
    return table.name.substr(quote + 1, table.name.rfind('"') - quote - 1);
}

/// An object with these keys, and nothing said of their values.
Json with_keys(const FieldTable& table) {
    Json keys = Json::object();
    for (const auto& field : table.fields) keys[std::string(field.key)] = Json::object();
    for (const auto& inner : table.tables) keys[std::string(inner.key())] = Json::object();
    return {{"properties", std::move(keys)}, {"additionalProperties", false}};
}

/// An entry of [[system.constraint]] or [[system.force]]: what its keys take, then which keys each kind has. An entry
/// with the name of an earlier one may say less: it changes it.
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

/// [system], or [a] and [b], which change what stands there.
Json side_schema(const std::vector<FieldTable>& film, bool may_change) {
    auto table = film[2];
    if (may_change) table.append(side_text_table());
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

/// [[curve]]: its keys, and sides on top of those of the preset.
Json entries_schema(const FieldTable& table) {
    auto entry = table_schema(table);
    entry["required"] = needed_keys(table);
    for (const auto* side : {"system", "a", "b"}) entry["properties"][side] = reference("side");
    return list_schema(entry, 0, 0);
}

bool is_of_entries(const FieldTable& table) {
    return table.name.starts_with("[[");
}

/// Which tables, and which keys of those that differ from kind to kind, a preset of this kind may have. What they hold
/// is not said again.
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
            const auto schema = is_of_entries(table) ? entries_schema(table) : table_schema(table);
            if (table.key().empty())
                properties.update(schema["properties"]);
            else if (auto& known = properties[std::string(table.key())]; known.is_null())
                known = schema;
            else  // what another kind knows of the same table: of [chart] and [system] some know more
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

}  // namespace doppel

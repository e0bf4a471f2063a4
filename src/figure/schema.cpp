#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "scene/resolved.hpp"

namespace doppel {
namespace {

/// For example "a whole number of samples. Unit: s. Range: > 0. Default: 30."
std::string description_of(const ListedField& field) {
    auto text = fmt::format("{}.", field.help);
    if (!field.unit.empty()) text += fmt::format(" Unit: {}.", field.unit);
    if (const auto range = field.range_text(); !range.empty()) text += fmt::format(" Range: {}.", range);
    return text + (field.is_needed() ? " Must be given." : fmt::format(" Default: {}.", field.by_default));
}

Json key_schema(const ListedField& field) {
    auto schema = field.type.schema(field);
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
            const auto schema = table.name.starts_with("[[") ? entries_schema(table) : table_schema(table);
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

}  // namespace doppel

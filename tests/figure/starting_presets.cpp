#include "figure/starting_presets.hpp"

#include "figure/kind_tables.hpp"
#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>

namespace doppel::test {
namespace {

/// Keys that most presets have; the others are written as comments.
constexpr std::array<std::string_view, 9> used_keys{"title",     "duration_s",      "sample_hz",
                                                    "links",     "mass_kg",         "length_m",
                                                    "angle_deg", "omega_deg_per_s", "gravity_m_per_s2"};

bool is_used(const FieldTable& table, std::string_view key) {
    if (table.is_entry()) return key == "scene" || key == "column";
    if (key == "difference") return true;
    if (table.key() == "system" && key == "accuracy") return true;
    return (table.key() == "scene" || table.key() == "system") && std::ranges::find(used_keys, key) != used_keys.end();
}

std::string starting_value(const ListedField& field) {
    if (field.key == "column") return "\"distance\"";
    if (field.key == "scene") return "\"butterfly\"";
    if (field.key == "difference") return "0.003";  // degrees, as in Kao's study
    if (field.key == "accuracy") return "1e-3";
    return field.example();
}

/// "# help (number, > 0; unit s; default: none)", then the key, commented out if it is rarely used.
std::string key_lines(const ListedField& field, const std::string& prefix, bool is_live) {
    auto takes = field.takes();
    if (!field.unit.empty()) takes += fmt::format("; unit {}", field.unit);
    if (field.default_value.empty()) takes += fmt::format("; default: {}", field.described_default);
    std::erase(takes, '`');
    return fmt::format("# {} ({})\n{}{}{} = {}\n", field.help, takes, is_live ? "" : "#", prefix, field.key,
                       starting_value(field));
}

std::string table_lines(const FieldTable& table, const std::string& prefix = "") {
    std::string text;
    for (const auto& field : table.fields)
        if (field.key != kind_field.key) text += key_lines(field, prefix, prefix.empty() && is_used(table, field.key));
    for (const auto& inner : table.tables) text += table_lines(inner, fmt::format("{}{}.", prefix, inner.key()));
    return text;
}

std::string first_lines(std::string_view kind) {
    const bool is_film = kind == pair_kind;
    return fmt::format(
        "# {0}. Take the # off a key, and change its value; then:\n#   doppel check {{file}}\n#   doppel {1} "
        "{{file}}\n",
        is_film ? "A film of two pendulums" : fmt::format("A figure of kind \"{}\"", kind),
        is_film ? "render" : "figure");
}

/// [a] or [b].
std::string side_lines(std::string_view side, std::string_view kind) {
    auto text = fmt::format("\n[{0}]  # what side {0} has otherwise: any keys of [system]\n", side);
    // the pairs of a grid differ in the key of its x axis
    if (side == "b" && kind != "grid") text += "angle_deg = [90.003, 90]\n";
    if (kind != pair_kind) return text;
    FieldTable texts("[a]");
    SideSpec none;
    side_text_fields(texts, none);
    return text + table_lines(texts);
}

/// Adds a line for each key: the kind of preset, "table.key", the help, and values to propose.
void add_settings(const FieldTable& table, const std::string& above, std::string_view kind,
                  std::set<std::string>& lines) {
    const auto name = table.key().empty() ? "" : fmt::format("{}{}.", above, table.key());
    for (const auto& inner : table.tables) add_settings(inner, name, kind, lines);
    for (const auto& field : table.fields) {
        std::set<std::string> values(field.names.begin(), field.names.end());  // they need no quotes
        const auto example = field.example();
        if (example == "true" || example == "false")
            values = {"false", "true"};
        else if (field.key == "key")
            values = {"theta1_deg", "theta2_deg", "mass_ratio", "length_ratio", "links", "setting"};
        else if (field.names.empty())
            values = {example};
        lines.insert(fmt::format("{}\t{}{}\t{}{}{}\t{}\n", kind, name, field.key, field.help,
                                 field.unit.empty() ? "" : ", ", field.unit, fmt::join(values, "\t")));
    }
}

}  // namespace

std::string starting_preset(std::string_view kind) {
    auto text = first_lines(kind);
    const auto tables = tables_of(kind);
    const bool has_sides = std::ranges::any_of(tables, [](const auto& table) { return table.key() == "a"; });
    for (const auto& table : tables) {
        const auto key = table.key();
        const bool is_entry = table.is_entry();
        if (key.empty()) {
            text += "\n# shown above the pictures\ntitle = {title}\n";
            for (const auto& field : table.fields)
                if (field.key != title_field.key) text += key_lines(field, "", false);
        } else if (key == "a" || key == "b") {
            text += side_lines(key, kind);
        } else {
            text += fmt::format("\n[{0}{1}{2}]{3}\n", is_entry ? "[" : "", key, is_entry ? "]" : "",
                                key == "system" && has_sides ? "  # both sides" : "");
            if (key == "scene" && kind != pair_kind) text += fmt::format("kind = {}\n", toml_text(std::string(kind)));
            text += table_lines(table);
            if (key == "system" && kind == pair_kind)
                text +=
                    "# [[system.torque]]: see docs/presets.md, and \"doppel show driven\"\n"
                    "# [[system.particle]], [[system.constraint]], [[system.force]]: see \"doppel show springs\"\n";
            if (key == "curve")
                text += "# [curve.system], [curve.a] and [curve.b]: what this curve's sides have otherwise\n";
        }
    }
    return text;
}

std::string listed_settings() {
    std::set<std::string> lines;
    for (const auto kind : scene_kinds)
        for (const auto& table : tables_of(kind))
            if (!table.is_entry()) add_settings(table, "", kind, lines);
    return fmt::format("{}", fmt::join(lines, ""));
}

}  // namespace doppel::test

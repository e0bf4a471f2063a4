#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "output/files.hpp"
#include "scene/preset_fields.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// Keys that most presets have; the others are written as comments.
constexpr std::array<std::string_view, 9> used_keys{"title",     "duration_s",      "sample_hz",
                                                    "links",     "mass_kg",         "length_m",
                                                    "angle_deg", "omega_deg_per_s", "gravity_m_per_s2"};

/// Keys of [system] that such figures set themselves.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> unused_keys{
    {{"section", "angle_deg"}, {"section", "omega_deg_per_s"}}};

bool is_used(const FieldTable& table, std::string_view key, std::string_view kind) {
    if (table.name.starts_with("[[")) return key == "scene" || key == "column";
    if (key == "difference") return true;
    if (table.key() == "system" && key == "accuracy") return true;
    return (table.key() == "scene" || table.key() == "system") &&
           std::ranges::find(used_keys, key) != used_keys.end() &&
           std::ranges::find(unused_keys, std::pair(kind, key)) == unused_keys.end();
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

std::string table_lines(const FieldTable& table, std::string_view kind, const std::string& prefix = "") {
    std::string text;
    for (const auto& field : table.fields)
        if (field.key != kind_field.key)
            text += key_lines(field, prefix, prefix.empty() && is_used(table, field.key, kind));
    for (const auto& inner : table.tables) text += table_lines(inner, kind, fmt::format("{}{}.", prefix, inner.key()));
    return text;
}

std::string first_lines(const fs::path& file, std::string_view kind) {
    const bool is_film = kind == pair_kind;
    return schema_line(file.parent_path().empty() ? "." : file.parent_path()) +
           fmt::format(
               "# {0}. Take the # off a key, and change its value; then:\n#   doppel check {1}\n#   doppel {2} {1}\n",
               is_film ? "A film of two pendulums" : fmt::format("A figure of kind \"{}\"", kind), file.string(),
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
    return text + table_lines(texts, kind);
}

/// A preset of that kind with all keys; rarely used ones are comments.
std::string starting_preset(const fs::path& file, std::string_view kind) {
    auto text = first_lines(file, kind);
    const auto tables = tables_of(kind);
    const bool has_sides = std::ranges::any_of(tables, [](const auto& table) { return table.key() == "a"; });
    for (const auto& table : tables) {
        const auto key = table.key();
        const bool is_entry = table.name.starts_with("[[");
        if (key.empty()) {
            text += fmt::format("\n# shown above the pictures\ntitle = {}\n", toml_text(file.stem().string()));
            for (const auto& field : table.fields)
                if (field.key != title_field.key) text += key_lines(field, "", false);
        } else if (key == "a" || key == "b") {
            text += side_lines(key, kind);
        } else {
            text += fmt::format("\n[{0}{1}{2}]{3}\n", is_entry ? "[" : "", key, is_entry ? "]" : "",
                                key == "system" && has_sides ? "  # both sides" : "");
            if (key == "scene" && kind != pair_kind) text += fmt::format("kind = {}\n", toml_text(std::string(kind)));
            text += table_lines(table, kind);
            if (key == "system" && kind == pair_kind)
                text += "# particles, constraints and forces: see docs/presets.md, and \"doppel show springs\"\n";
            if (key == "curve")
                text += "# [curve.system], [curve.a] and [curve.b]: what this curve's sides have otherwise\n";
        }
    }
    return text;
}

void write_preset(const fs::path& path, std::string_view kind) {
    if (path.extension() != ".toml" || path.stem().empty())
        throw bad_input("{}: the name of a preset's file ends in .toml", path.string());
    const PresetText preset{path.stem().string(), path.string(), starting_preset(path, kind), path.string()};
    if (kind == pair_kind)
        read_preset(preset);  // the title must be drawable
    else
        read_figure(preset);
    std::error_code ignored;
    if (fs::exists(fs::symlink_status(path, ignored)))
        throw bad_input("{}: exists already; give a new name", path.string());
    ignore_sigpipe();
    const auto folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored)) throw cannot(folder, "opened", ENOENT);
    const SingleFile file(path, "");
    write_file(file.place(), preset.text);
    file.publish();
    report_files(on_one_line(fmt::format("{0}: edit it, then: doppel check {0}", path.string())) + "\n");
}

}  // namespace

void add_init(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto kind = std::make_shared<std::string>(pair_kind);
    auto& command = *app.add_subcommand("init", "Writes a preset with every key, its help and its default");
    command.footer(
        "Examples:\n"
        "  doppel init mine.toml && doppel render mine.toml\n"
        "  doppel init --figure section sections.toml && doppel figure sections.toml");
    command.add_option("FILE", *name, "The new file, which ends in .toml; default for a figure: KIND.toml");
    std::vector<std::string> kinds;
    for (const auto& figure : figure_kinds()) kinds.emplace_back(figure.name);
    auto* figure =
        command.add_option("--figure", *kind, "A figure of this kind, and not a film")->check(CLI::IsMember(kinds));
    command.callback([name, kind, figure] {
        if (name->empty() && figure->count() == 0)
            throw bad_input("init needs the name of the new file: doppel init FILE.toml");
        write_preset(name->empty() ? *kind + ".toml" : *name, *kind);
    });
}

}  // namespace doppel

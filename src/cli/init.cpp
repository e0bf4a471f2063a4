#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "figure/preset.hpp"
#include "output/folder.hpp"
#include "scene/preset_fields.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// Of [system], what most presets say; the rest is written as comments.
constexpr std::array<std::string_view, 9> used_keys{"title",     "duration_s",      "sample_hz",
                                                    "links",     "mass_kg",         "length_m",
                                                    "angle_deg", "omega_deg_per_s", "gravity_m_per_s2"};

/// "# help (number, > 0; unit s; default: none)", then the key, as a comment where it is seldom used.
std::string key_lines(const ListedField& field, const std::string& prefix) {
    const bool is_live = prefix.empty() && std::find(used_keys.begin(), used_keys.end(), field.key) != used_keys.end();
    auto text = fmt::format("# {} ({}", field.help, plain_words(field.takes()));
    if (!field.unit.empty()) text += fmt::format("; unit {}", field.unit);
    if (field.default_value().empty()) text += fmt::format("; default: {}", plain_words(field.by_default));
    return fmt::format("{})\n{}{}{} = {}\n", text, is_live ? "" : "#", prefix, field.key, field.example());
}

std::string table_lines(const FieldTable& table, const std::string& prefix = "") {
    std::string text;
    for (const auto& field : table.fields)
        if (field.key != kind_field.key) text += key_lines(field, prefix);
    for (const auto& inner : table.tables) text += table_lines(inner, fmt::format("{}{}.", prefix, inner.key()));
    return text;
}

/// A film's preset, with every key: those that most presets have, and the others as comments.
std::string starting_preset(const fs::path& file) {
    auto text = schema_line(file.parent_path().empty() ? "." : file.parent_path()) +
                fmt::format(
                    "# A film of two pendulums. Take the # off a key, and change its value; then:\n"
                    "#   doppel check {0}\n#   doppel render {0}\n",
                    file.string());
    for (const auto& table : tables_of(pair_kind)) {
        const auto key = table.key();
        if (key.empty()) {
            text += fmt::format("\n# shown above the pictures\ntitle = {}\n", toml_text(file.stem().string()));
            for (const auto& field : table.fields)
                if (field.key != title_field.key) text += key_lines(field, "");
        } else if (key == "a" || key == "b") {
            text += fmt::format("\n[{0}]  # what side {0} has otherwise: any keys of [system]\n", key);
            if (key == "b") text += "angle_deg = [90.003, 90]\n";
            text += table_lines(side_text_table());
        } else {
            text += fmt::format("\n[{}]{}\n{}", key, key == "system" ? "  # both sides" : "", table_lines(table));
            if (key == "system")
                text += "# particles, constraints and forces: see docs/presets.md, and \"doppel show springs\"\n";
        }
    }
    return text;
}

}  // namespace

void add_init(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("init", "Writes a preset to start from: every key, with help and default");
    command.footer("Example:\n  doppel init mine.toml && doppel render mine.toml");
    command.add_option("FILE", *name, "The new file, which ends in .toml")->required();
    command.callback([name] {
        const fs::path path = *name;
        if (path.extension() != ".toml" || path.stem().empty())
            throw bad_input("{}: the name of a preset's file ends in .toml", path.string());
        const auto text = starting_preset(path);
        read_preset({path.stem().string(), path.string(), text, path.string()});  // a title that can be drawn
        std::error_code ignored;
        if (fs::exists(fs::symlink_status(path, ignored)))
            throw bad_input("{}: is there already; give the name of a new file", path.string());
        write_file(path, text);
        print_line("{0}: edit it, then: doppel check {0}", path.string());
    });
}

}  // namespace doppel

#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "embedded/cli.hpp"
#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "output/files.hpp"
#include "scene/preset_fields.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// The preset of that kind with all keys; rarely used ones are comments. Made by tests/figure/starting_presets.cpp.
std::string starting_preset(const fs::path& file, std::string_view kind) {
    const auto text = embedded_file(cli_files(), fmt::format("{}.toml.in", kind));
    return schema_line(file.parent_path().empty() ? "." : file.parent_path()) +
           fmt::format(fmt::runtime(text), fmt::arg("file", file.string()),
                       fmt::arg("title", toml_text(file.stem().string())));
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

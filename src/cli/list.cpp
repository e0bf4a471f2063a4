#include "base/read_file.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "figure/preset.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <sstream>

namespace doppel {

namespace {

/// The films or the figures among the presets, and their titles.
void list_presets(bool figures) {
    std::vector<std::pair<std::string, std::string>> lines;
    std::size_t width = 0;
    for (const auto& preset : builtin_presets()) {
        if (is_figure(preset) != figures) continue;
        lines.emplace_back(preset.name, figures ? read_figure(preset).title : read_preset(preset).title);
        width = std::max(width, preset.name.size());
    }
    for (const auto& [name, title] : lines) print_line("{:<{}}  {}", name, width, title);
}

/// A table: value of `integrator`, order, step or tolerance, models, properties.
void list_methods() {
    print_line("{:<20} {:>5}  {:<10} {:<32} {}", "integrator", "order", "goes by", "models", "properties");
    for (const auto& method : methods())
        print_line("{:<20} {:>5}  {:<10} {:<32} {}: {}", method.name,
                   method.order == 0 ? "any" : fmt::format("{}", method.order),
                   method.adaptive ? "tolerance" : "step_s", fmt::format("{}", fmt::join(models_of(method), ", ")),
                   method.title, method.properties);
}

/// As it is into a file; a terminal gets lines that it can but show.
void show(const std::string& text) {
    if (!isatty(STDOUT_FILENO)) return write_out(text);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) print_line("{}", line);
}

}  // namespace

void add_list(CLI::App& app) {
    auto what = std::make_shared<std::string>("presets");
    auto& command = *app.add_subcommand("list", "The presets and their titles; list methods: what steps them");
    command.add_option("WHAT", *what, "presets (films, then figures) or methods")
        ->check(CLI::IsMember({"presets", "methods"}))
        ->capture_default_str();
    command.callback([what] {
        if (*what == "methods") return list_methods();
        list_presets(false);
        print_line("");
        print_line("figures, for doppel figure:");
        list_presets(true);
    });
}

void add_show(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("show", "The TOML of a preset, a start for one of your own");
    command.footer("Example:\n  doppel show butterfly > mine.toml");
    command.add_option("PRESET", *name, "Name (see doppel list) or path")->required();
    command.callback([name] {
        const auto preset = find_preset(*name, &watch_interrupts());
        show(preset.call == preset.name ? with_schema_line(preset.text) : preset.text);
    });
}

namespace {

namespace fs = std::filesystem;
constexpr std::string_view directive = "#:schema ", address_of_file = "file://";

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

}  // namespace

std::string schema_line(const fs::path& folder) {
    std::error_code ignored;
    if (const fs::path here = "presets/preset.schema.json"; is_file(here)) {
        const auto way = fs::relative(here, folder, ignored);
        if (!ignored) return fmt::format("{}{}{}\n", directive, *way.begin() == ".." ? "" : "./", way.string());
    }
    const auto program = fs::read_symlink("/proc/self/exe", ignored);
    const auto installed = (program.parent_path() / "../share/doppel/presets/preset.schema.json").lexically_normal();
    return is_file(installed) ? fmt::format("{}{}{}\n", directive, address_of_file, installed.string()) : "";
}

std::string with_schema_line(const std::string& text) {
    return text.starts_with(directive) ? schema_line() + text.substr(text.find('\n') + 1) : text;
}

std::optional<std::string> schema_line_fault(const PresetText& preset) {
    if (!is_file(preset.path)) return std::nullopt;  // built in
    std::istringstream lines(preset.text);
    int number = 0;
    std::string line;
    do {
        if (!std::getline(lines, line) || !line.starts_with('#')) return std::nullopt;
        ++number;
    } while (!line.starts_with(directive));
    auto name = line.substr(directive.size());
    name.erase(name.find_last_not_of(" \t\r") + 1);
    if (name.starts_with(address_of_file)) name.erase(0, address_of_file.size());
    if (name.find("://") != std::string::npos) return std::nullopt;
    const auto path = fs::path(preset.path).parent_path() / name;
    const auto fault = [&](std::string_view what) {
        return fmt::format("{}:{}:1: #:schema names {}, {}; \"doppel schema\" prints the one that editors want",
                           preset.path, number, path.string(), what);
    };
    if (!is_file(path)) return fault("and there is no such file");
    const auto text = read_whole_file(path, {"a schema is a JSON file", std::size_t{8} << 20});
    return text == preset_schema() ? std::nullopt : std::optional(fault("which is not this program's schema"));
}

void add_schema(CLI::App& app) {
    auto& command = *app.add_subcommand("schema", "The JSON schema of presets, which editors of TOML read");
    command.footer(
        "Example:\n"
        "  doppel schema > preset.schema.json    # for presets beside it that begin with #:schema "
        "./preset.schema.json");
    command.callback([] { write_out(preset_schema()); });
}

}  // namespace doppel

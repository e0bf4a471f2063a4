#include "cli/program.hpp"
#include "cli/schema.hpp"
#include "cli/terminal.hpp"
#include "figure/preset.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>
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

}  // namespace doppel

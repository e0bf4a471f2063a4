#include "base/error.hpp"
#include "base/read_file.hpp"
#include "cli/options.hpp"
#include "embedded/cli.hpp"
#include "figure/kinds.hpp"
#include "figure/preset.hpp"
#include "output/files.hpp"
#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

/// Title and kind of a preset, and its path unless it is built in (null). If the file cannot be read, they are null,
/// and "error" is the reason.
Json entry_of(const PresetText& preset, const Json& path) {
    Json entry{{"name", preset.name}, {"title", nullptr}, {"kind", nullptr}, {"path", path}};
    try {
        const auto kind = kind_of_preset(preset);
        entry["title"] = kind == pair_kind ? read_preset(preset).title : read_figure(preset).title;
        entry["kind"] = kind;
    } catch (const Error& error) {
        if (path.is_null() || error.code() != ExitCode::bad_input) throw;
        entry["error"] = error.what();
    }
    return entry;
}

/// Presets by name: those in this folder, and built-in ones without a file here.
std::map<std::string, Json> all_presets() {
    std::map<std::string, Json> entries;
    for (const auto& path : preset_files_here()) {
        if (entries.contains(path.stem().string())) continue;
        const auto preset = find_preset(path.string(), &watch_interrupts());
        entries.emplace(preset.name, entry_of(preset, path.string()));
    }
    for (const auto& preset : builtin_presets())
        if (!entries.contains(preset.name)) entries.emplace(preset.name, entry_of(preset, nullptr));
    return entries;
}

void list_presets() {
    const auto all = all_presets();
    const auto heading_of = [](const Json& entry) {
        return entry.contains("error")      ? "cannot be read:"
               : entry["kind"] == pair_kind ? ""
                                            : "figures, for doppel figure:";
    };
    for (const std::string_view heading : {"", "figures, for doppel figure:", "cannot be read:"}) {
        std::size_t width = 0;
        for (const auto& [name, entry] : all)
            if (heading == heading_of(entry)) width = std::max(width, name.size());
        if (width > 0 && !heading.empty()) {
            print_line("");
            print_line("{}", heading);
        }
        for (const auto& [name, entry] : all)
            if (heading == heading_of(entry))
                print_line("{:<{}}  {}", name, width,
                           entry[entry.contains("error") ? "error" : "title"].get<std::string>());
    }
}

/// A table of methods: value of `integrator`, order, step size or tolerance, models, properties.
void list_methods() {
    print_line("{:<20} {:>5}  {:<10} {:<32} {}", "integrator", "order", "setting", "models", "properties");
    for (const auto& method : methods())
        print_line("{:<20} {:>5}  {:<10} {:<32} {}: {}", method.name,
                   method.order == 0 ? "any" : fmt::format("{}", method.order),
                   method.adaptive ? "tolerance" : "step_s", fmt::format("{}", fmt::join(models_of(method), ", ")),
                   method.title, method.properties);
}

/// Unchanged into a file; sanitised on a terminal.
void show(const std::string& text) {
    if (!isatty(STDOUT_FILENO)) return write_out(text);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) print_line("{}", line);
}

std::string_view preset_schema() {
    return embedded_file(cli_files(), "preset.schema.json");
}

constexpr std::string_view directive = "#:schema ", address_of_file = "file://";

bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

/// The first line of a preset in `folder`, "#:schema PATH\n": the schema in presets/ of the current folder, or the
/// installed one; empty if there is neither.
std::string schema_line(const fs::path& folder = ".") {
    std::error_code ignored;
    if (const fs::path here = "presets/preset.schema.json"; is_file(here)) {
        const auto way = fs::relative(here, folder, ignored);
        if (!ignored) return fmt::format("{}{}{}\n", directive, *way.begin() == ".." ? "" : "./", way.string());
    }
    const auto program = fs::read_symlink("/proc/self/exe", ignored);
    const auto installed = (program.parent_path() / "../share/doppel/presets/preset.schema.json").lexically_normal();
    return is_file(installed) ? fmt::format("{}{}{}\n", directive, address_of_file, installed.string()) : "";
}

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
    check_preset_name(path.string(), path.stem().string());
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
    SingleFile file(path, "");
    write_file(file.place, preset.text);
    file.parts.publish();
    report_files(on_one_line(fmt::format("{0}: edit it, then: doppel check {0}", path.string())) + "\n");
}

}  // namespace

std::vector<fs::path> preset_files_here() {
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto* folder : {"presets", "presets/figures"})
        for (const auto& file : fs::directory_iterator(folder, ignored))
            if (file.path().extension() == ".toml" && file.is_regular_file(ignored)) files.push_back(file.path());
    return files;
}

void print_json(const Json& json) {
    write_out(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void add_list(CLI::App& app) {
    auto what = std::make_shared<std::string>("presets");
    auto as_json = std::make_shared<bool>(false);
    auto& command = *app.add_subcommand("list", "Lists presets and their titles; list methods: the integrators");
    command.footer(
        "Presets in presets/ and presets/figures/ here are listed, too.\n"
        "--json: an array of {\"name\", \"title\", \"kind\": \"pair\" or that of a figure, \"path\"}; the path is "
        "null\n"
        "of what is built in. A preset that cannot be read has title and kind null, and \"error\".");
    command.add_option("WHAT", *what, "presets (films, then figures) or methods")
        ->check(CLI::IsMember({"presets", "methods"}))
        ->capture_default_str();
    command.add_flag("--json", *as_json, "The presets as JSON");
    command.callback([what, as_json] {
        if (*as_json && *what == "methods") throw bad_input("--json is only for presets, not for methods");
        if (*what == "methods") return list_methods();
        if (!*as_json) return list_presets();
        auto list = Json::array();
        for (const auto& [name, entry] : all_presets()) list.push_back(entry);
        print_json(list);
    });
}

void add_show(CLI::App& app) {
    auto name = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("show", "Prints the TOML of a preset, to start your own from");
    command.footer("Example:\n  doppel show butterfly > mine.toml");
    command.add_option("PRESET", *name, "Name (see doppel list) or path")->required();
    command.callback([name] {
        const auto preset = find_preset(*name, &watch_interrupts());
        // of a built-in preset, the schema line is replaced
        const bool replaces = preset.call == preset.name && preset.text.starts_with(directive);
        show(replaces ? schema_line() + preset.text.substr(preset.text.find('\n') + 1) : preset.text);
    });
}

std::optional<std::string> schema_line_error(const PresetText& preset) {
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
    const auto error = [&](std::string_view what) {
        return fmt::format("{}:{}:1: #:schema names {}, {}; \"doppel schema\" prints the one that editors want",
                           preset.path, number, path.string(), what);
    };
    if (!is_file(path)) return error("and there is no such file");
    const auto text = read_whole_file(path, {"a schema is a JSON file", std::size_t{8} << 20});
    return text == preset_schema() ? std::nullopt : std::optional(error("which is not this program's schema"));
}

void add_schema(CLI::App& app) {
    auto& command = *app.add_subcommand("schema", "Prints the JSON schema of presets, for editors");
    command.footer(
        "Example:\n"
        "  doppel schema > preset.schema.json    # beside presets that begin #:schema ./preset.schema.json");
    command.callback([] { write_out(preset_schema()); });
}

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

#pragma once

#include "film/run.hpp"
#include "scene/preset.hpp"

#include <CLI/App.hpp>

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// What commands that take presets have in common, as it was typed.
struct PresetOptions {
    std::vector<std::string> presets, sets;
    std::string beside = {};
};

/// What commands that run presets have besides.
struct RunCommandOptions : PresetOptions {
    std::string out = "out", progress = "auto", columns = {};
    int jobs = 0;
    bool force = false;
};

void add_preset_options(CLI::App& command, PresetOptions& options);
/// --beside.
void add_beside_option(CLI::App& command, PresetOptions& options);
/// What --beside FILE puts on top of a preset and the overrides `given`, with these: side a shows the track, and side b starts
/// as fitted to its first two seconds and runs for as long as it lasts. Throws Error as read_preset() does.
std::vector<Override> beside_overrides(const PresetText& text, const std::vector<Override>& given,
                                       const std::string& track, const std::atomic<bool>& stop);
/// Refuses "-" for an option that names a folder or a file, where people mean standard output.
CLI::Option* refuse_dash(CLI::Option* option);
/// --out, --progress and --force.
void add_out_options(CLI::App& command, std::string& out, std::string& progress, bool& force);
/// The same, and --jobs; `jobs` = what it counts, for the help.
void add_run_options(CLI::App& command, RunCommandOptions& options, const std::string& jobs);

/// --columns, and its value as RunOptions has it.
void add_columns_option(CLI::App& command, std::string& columns);
std::vector<std::string> columns_of_option(const std::string& text);

/// --gl, a name of gl_named().
void add_gl_option(CLI::App& command, std::string& gl);

/// "A<separator>B" as two whole numbers; nothing where it is not.
std::optional<std::pair<long, long>> two_numbers(const std::string& text, char separator);

/// The value of --at, --from or --to, "6.8" or "1/3". Throws Error (exit 2).
Rational seconds_of_option(const std::string& option, const std::string& text);

/// --size WIDTHxHEIGHT as the key of a preset that it sets. Throws Error (exit 2).
Override size_override(const std::string& key, const std::string& size);

/// Throws Error (exit 2) where results of two presets, `paths`, would go to the same place.
void check_names(const std::vector<std::string>& names, const std::vector<std::string>& paths);

/// The values of --set.
std::vector<Override> overrides_of(const PresetOptions& options);

/// The files that the scenes are read from: presets, tracks and fonts.
std::vector<std::filesystem::path> inputs_of(const std::vector<std::string>& presets, const std::vector<Scene>& scenes);

/// The scene of each preset, all of them read before the first one runs. `more` = overrides from other options.
std::vector<Scene> read_scenes(const PresetOptions& options, const std::vector<Override>& more = {});

/// Calls work(scene, report) for one scene after the other and tells the person how far it is, in `unit`.
void work_on_all(const std::vector<Scene>& scenes, const std::string& progress, const std::string& unit,
                 const std::function<RunResult(const Scene&, const std::function<void(const Progress&)>&)>& work);

/// Runs the scenes one after the other and tells the person how far they are.
void run_all(const std::vector<Scene>& scenes, const RunCommandOptions& options, RunOptions run_options);

/// The first line of a preset in `folder`, "#:schema PATH\n": the schema in presets/ here, or else the one that is
/// installed with the program; empty where there is neither.
std::string schema_line(const std::filesystem::path& folder = ".");

/// The text of a preset that came with the program, with that line in place of its own.
std::string with_schema_line(const std::string& text);

/// What is wrong with the line of a preset's file: it names a file that is not there, or not this program's schema.
std::optional<std::string> schema_line_fault(const PresetText& preset);

/// What the scripts of "doppel completion" ask for, "doppel complete SHELL WORD…": what the last word may become, a line
/// each; for zsh and fish with a tab and a few words on it. The words are as they were typed, quotes included.
std::string completions(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace doppel

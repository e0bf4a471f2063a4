#pragma once

#include "cli/terminal.hpp"
#include "film/run.hpp"
#include "output/transaction.hpp"
#include "scene/preset.hpp"
#include "scene/resolved.hpp"

#include <CLI/App.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// Options common to commands that take presets, as typed.
struct PresetOptions {
    std::vector<std::string> presets, sets;
    std::string beside = {};
    bool wants_proof = true;  // of presets with certify = true
};

/// Options of commands that write files.
struct OutOptions {
    std::string out = "out";
    ProgressStyle progress = ProgressStyle::automatic;
    bool force = false, list_outputs = false;
};

/// Further options of commands that run presets.
struct RunCommandOptions : PresetOptions, OutOptions {
    std::string columns = {}, recording = {};
    int jobs = 0;
};

/// An option with a value; help shows its `type`.
template <class T>
CLI::Option* add_value(CLI::App& command, const std::string& names, T& value, const std::string& type,
                       const std::string& help) {
    return command.add_option(names, value, help)->type_name(type);
}
using Choices = std::vector<std::string>;
/// An option that takes the name of a value of an enumeration; help shows the default.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& names, T& value, const std::string& type,
                        const std::string& help, const Choices& choices = {names_of<T>.begin(), names_of<T>.end()}) {
    const auto set = [&value](const std::string& name) { value = value_named<T>(name); };
    return command.add_option_function<std::string>(names, set, help)
        ->type_name(type)
        ->check(CLI::IsMember(choices))
        ->default_str(std::string(name_of(value)));
}

/// --set.
CLI::Option* add_set_option(CLI::App& command, PresetOptions& options);
/// PRESET… and --set.
void add_preset_options(CLI::App& command, PresetOptions& options);
/// Refuses "-" for an option that names a folder or a file, as it usually means standard output.
CLI::Option* refuse_dash(CLI::Option* option);
/// --out, --list-outputs, --progress and --force.
void add_out_options(CLI::App& command, OutOptions& options);
/// The same, and --jobs; `jobs` = what is counted, for the help.
void add_run_options(CLI::App& command, RunCommandOptions& options, const std::string& jobs);

/// --gl: a name of Gl.
CLI::Option* add_gl_option(CLI::App& command, Gl& gl);

/// --shard I/N; nothing if the text is empty. Throws Error (exit 2).
std::optional<Shard> shard_of_option(const std::string& text, bool merges);
/// --frames A:B: the first frame, and the one after the last. Throws Error (exit 2).
std::pair<long, long> frames_of_option(const std::string& text);
/// The value of --at, --from or --to, "6.8" or "1/3". Throws Error (exit 2).
Rational seconds_of_option(const std::string& option, const std::string& text);

/// --quality.
void add_quality_option(CLI::App& command, std::string& quality);
/// --size WIDTHxHEIGHT, --format and, of films, --quality, where they are given, as overrides in the table "video" or
/// "chart". Throws Error (exit 2).
std::vector<Override> picture_overrides(const std::string& table, const std::string& size,
                                        const std::string& format = {}, const std::string& quality = {});

/// Throws Error (exit 2) if the results of two presets, `paths`, would have the same names.
void check_names(const std::vector<std::string>& names, const std::vector<std::string>& paths);

/// Reads the scenes of all presets before the first one runs, with the progress of their proofs. `more` = overrides from
/// other options.
std::vector<Scene> read_scenes(const PresetOptions& options, ProgressStyle progress,
                               const std::vector<Override>& more = {});
/// The files that these runs read.
std::vector<std::filesystem::path> inputs_of(const std::vector<std::string>& presets, const std::vector<Scene>& scenes);

/// Calls work(scene, report) for each scene, with progress in `unit`. `streamed` as for ProgressReport.
void work_on_all(const std::vector<Scene>& scenes, ProgressStyle progress, const std::string& unit,
                 const std::string& streamed, const std::function<void(const Scene&, ProgressReport&)>& work);

/// The values of --set, and `more` after them.
std::vector<Override> overrides_of(const PresetOptions& options, const std::vector<Override>& more = {});

/// The output folder: that of --out; or for "-" a temporary folder, from which one file goes to standard output.
struct Destination {
    /// `ending` = extension of that file, ".csv". Throws Error: exit 2 for several runs, or if a picture would go to a
    /// terminal; exit 4. With --list-outputs there is no folder.
    Destination(const OutOptions& options, std::size_t runs, const std::string& ending);

    std::optional<TemporaryFolder> own;
    std::filesystem::path folder;
    std::string streamed;  // as for ProgressReport
};

/// A transaction of one file in any folder, whose manifests are not read.
struct SingleFile {
    /// Throws Error: exit 2 if the path is that of a folder, exit 4 if the file cannot be written, or exists and is not
    /// Doppel's or does not begin with `start`.
    SingleFile(const std::filesystem::path& path, std::string_view start);

    Transaction parts;
    std::filesystem::path place;  // to write to, until parts.publish()
};

/// --list-outputs: prints the files of the run NAME, one per line; folders end in "/".
void list_outputs(const OutOptions& options, const std::string& name, const std::vector<std::string>& files);

/// Prints to standard output.
void print_json(const Json& json);

std::vector<std::filesystem::path> preset_files_here();

/// The error in the schema line of a preset's file: it names a missing file, or not this program's schema.
std::optional<std::string> schema_line_error(const PresetText& preset);

/// The output of "doppel complete WORD…" for the scripts of "doppel completion": completions of the last word, one per
/// line, each with a tab and a description. The words are without quotes; the last may be incomplete.
std::string completions(CLI::App& app, const std::vector<std::string>& words);

// Each adds a command: its options, its help, and its action.
void add_render(CLI::App& app);
void add_simulate(CLI::App& app);
void add_still(CLI::App& app);
void add_figure(CLI::App& app);
void add_fit(CLI::App& app);
void add_compare(CLI::App& app, int& exit_code);  // sets the exit code 1 if pictures differ
void add_list(CLI::App& app);
void add_show(CLI::App& app);
void add_check(CLI::App& app);
void add_certify(CLI::App& app);
void add_schema(CLI::App& app);
void add_init(CLI::App& app);
void add_completion(CLI::App& app);

}  // namespace doppel

#pragma once

#include "film/run.hpp"
#include "output/files.hpp"
#include "scene/preset.hpp"
#include "scene/resolved.hpp"

#include <CLI/App.hpp>

#include <atomic>
#include <filesystem>
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

/// What commands that write files have.
struct OutOptions {
    std::string out = "out", progress = "auto";
    bool force = false, list_outputs = false;
};

/// What commands that run presets have besides.
struct RunCommandOptions : PresetOptions, OutOptions {
    std::string columns = {};
    int jobs = 0;
};

/// An option with a value, which help calls `type`.
template <class T>
CLI::Option* add_value(CLI::App& command, const std::string& names, T& value, const std::string& type,
                       const std::string& help) {
    return command.add_option(names, value, help)->type_name(type);
}
/// The same of one of some names; help says which holds where none is given, if one does.
CLI::Option* add_choice(CLI::App& command, const std::string& names, std::string& value, const std::string& type,
                        const std::string& help, const std::vector<std::string>& choices);

void add_preset_options(CLI::App& command, PresetOptions& options);
/// What --beside FILE puts on top of a preset and the overrides `given`, with these: side a shows the track, and side b starts
/// as fitted to its first two seconds and runs for as long as it lasts. Throws Error as read_preset() does.
std::vector<Override> beside_overrides(const PresetText& text, const std::vector<Override>& given,
                                       const std::string& track, const std::atomic<bool>& stop);
/// Refuses "-" for an option that names a folder or a file, where people mean standard output.
CLI::Option* refuse_dash(CLI::Option* option);
/// --out, --list-outputs, --progress and --force.
void add_out_options(CLI::App& command, OutOptions& options);
/// The same, and --jobs; `jobs` = what it counts, for the help.
void add_run_options(CLI::App& command, RunCommandOptions& options, const std::string& jobs);

/// --gl, a name of gl_named().
void add_gl_option(CLI::App& command, std::string& gl);

/// "A<separator>B" as two whole numbers; nothing where it is not.
std::optional<std::pair<long, long>> two_numbers(const std::string& text, char separator);

/// --size WIDTHxHEIGHT as the key of a preset that it sets. Throws Error (exit 2).
Override size_override(const std::string& key, const std::string& size);

/// Throws Error (exit 2) where results of two presets, `paths`, would go to the same place.
void check_names(const std::vector<std::string>& names, const std::vector<std::string>& paths);

/// The values of --set.
std::vector<Override> overrides_of(const PresetOptions& options);

/// Where results go: the folder of --out; or for "-" one of its own, removed with this, from which one file goes to
/// standard output.
class Destination {
public:
    /// `ending` = of that file's name, ".csv". Throws Error: exit 2 where there are several runs, or a picture would go to
    /// a terminal; exit 4.
    Destination(const std::string& out, std::size_t runs, const std::string& ending);

    const std::filesystem::path& folder() const { return folder_; }
    /// As ProgressReport has it.
    const std::string& streamed() const { return streamed_; }

private:
    std::optional<TemporaryFolder> own_;
    std::filesystem::path folder_;
    std::string streamed_;
};

/// One file in a folder that may hold anything, which is made where it is missing. It is written under a hidden name and
/// moved to its place when it is whole; destroyed before, it leaves nothing of it.
class LoneFile {
public:
    /// Throws Error (exit 4) where the file could not be written, or is another's than the one that begins with `start`.
    LoneFile(std::filesystem::path path, std::string_view start);
    ~LoneFile();
    LoneFile(const LoneFile&) = delete;
    LoneFile& operator=(const LoneFile&) = delete;

    /// Where to write it.
    const std::filesystem::path& place() const { return place_; }
    void publish() const;

private:
    std::filesystem::path path_, place_;
};

/// --list-outputs: the files of the run NAME, a line each; a folder ends in "/".
void list_outputs(const OutOptions& options, const std::string& name, const std::vector<std::string>& files);

/// On standard output.
void print_json(const Json& json);

/// The presets that lie in presets/ and presets/figures/ here.
std::vector<std::filesystem::path> preset_files_here();

/// The first line of a preset in `folder`, "#:schema PATH\n": the schema in presets/ here, or else the one that is
/// installed with the program; empty where there is neither.
std::string schema_line(const std::filesystem::path& folder = ".");

/// The text of a preset that came with the program, with that line in place of its own.
std::string with_schema_line(const std::string& text);

/// What is wrong with the line of a preset's file: it names a file that is not there, or not this program's schema.
std::optional<std::string> schema_line_fault(const PresetText& preset);

/// What the scripts of "doppel completion" ask for, "doppel complete WORD…": what the last word may become, a line each,
/// with a tab and a few words on it. The words are without their quotes, whole or not.
std::string completions(CLI::App& app, const std::vector<std::string>& words);

}  // namespace doppel

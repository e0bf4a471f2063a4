#include "cli/options.hpp"

#include "base/error.hpp"

#include <CLI/CLI.hpp>
#include <unistd.h>

#include <charconv>
#include <system_error>

namespace doppel {

CLI::Option* add_set_option(CLI::App& command, PresetOptions& options) {
    return add_value(command, "--set", options.sets, "KEY=VALUE",
                     "Another value for a key, in TOML; a word needs no quotes:\n"
                     "--set video.theme=light --set 'system.mass_kg[1]=2'\n"
                     "--set system.force.NAME.length_m=1.2")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_preset_options(CLI::App& command, PresetOptions& options) {
    command.add_option("PRESET", options.presets, "Names (see doppel list) or TOML files")->required();
    add_set_option(command, options);
}

CLI::Option* refuse_dash(CLI::Option* option) {
    return option->check([](const std::string& path) {
        return path == "-" ? "cannot be standard output here; give a name, or ./- for a file of that name" : "";
    });
}

void add_out_options(CLI::App& command, OutOptions& options) {
    add_value(command, "-o,--out", options.out, "DIR",
              "Folder for the results, DIR/NAME/; -: standard output, at the end")
        ->capture_default_str();
    command.add_flag("--list-outputs", options.list_outputs, "Only list the files that would be written, a line each");
    add_choice(command, "--progress", options.progress, "STYLE", "How to show progress; warnings are always shown");
    command.add_flag("--force", options.force, "Replace files that were changed, or that another kind of run wrote");
}

Destination::Destination(const OutOptions& options, std::size_t runs, const std::string& ending) : folder(options.out) {
    if (options.out != "-") return;
    if (runs != 1) throw bad_input("-o -: standard output takes one file; give one preset, not {}", runs);
    if (options.list_outputs) return;
    if (ending != ".csv" && isatty(STDOUT_FILENO))
        throw bad_input("-o -: standard output is a terminal, which cannot show {}; redirect it: -o - > FILE{}",
                        ending.substr(1), ending);
    folder = own.emplace().path();
    streamed = ending;
}

namespace {

/// Parses "A<separator>B" as two whole numbers; returns nothing otherwise.
std::optional<std::pair<long, long>> two_numbers(const std::string& text, char separator) {
    long first = 0, second = 0;
    const char* const end = text.data() + text.size();
    const auto [middle, error] = std::from_chars(text.data(), end, first);
    if (error != std::errc() || middle == end || *middle != separator) return std::nullopt;
    const auto [stop, second_error] = std::from_chars(middle + 1, end, second);
    if (second_error != std::errc() || stop != end) return std::nullopt;
    return std::pair{first, second};
}

/// The folder of the file; if it is a link, the folder that it leads to.
std::filesystem::path folder_of(const std::filesystem::path& file) {
    if (!file.has_filename()) throw bad_input("{} names a folder; give the name of a file", file.string());
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    if (type_of(folder) != std::filesystem::file_type::symlink) return folder;
    std::error_code error;
    const auto target = std::filesystem::weakly_canonical(folder, error);
    if (error) throw cannot(folder, "reached", error.value());
    return target;
}

}  // namespace

SingleFile::SingleFile(const std::filesystem::path& path, std::string_view start)
    : parts(folder_of(path), path.filename(), "", {.reads_manifests = false}) {
    if (type_of(path) == std::filesystem::file_type::regular && start_of_file(path, start.size()) != start)
        throw io_failed("{} was not written by Doppel for this; give another file name", path.string());
    place = parts.file(path.filename());
}

void list_outputs(const OutOptions& options, const std::string& name, const std::vector<std::string>& files) {
    if (options.out == "-") return print_line("-");
    for (const auto& file : files) print_line("{}", (std::filesystem::path(options.out) / name / file).string());
}

void add_run_options(CLI::App& command, RunCommandOptions& options, const std::string& jobs) {
    add_preset_options(command, options);
    add_out_options(command, options);
    add_value(command, "-j,--jobs", options.jobs, "N", jobs)->check(CLI::Range(1, 1024));
}

CLI::Option* add_gl_option(CLI::App& command, Gl& gl) {
    return add_choice(command, "--gl", gl, "NAME", "OpenGL library; auto: OSMesa, or EGL if OSMesa is missing");
}

std::optional<Shard> shard_of_option(const std::string& text, bool merges) {
    if (text.empty()) return std::nullopt;
    const auto parts = two_numbers(text, '/');
    if (!parts || parts->first < 1 || parts->second < parts->first || parts->second > max_parts)
        throw bad_input("--shard must be I/N with 1 ≤ I ≤ N ≤ {}, shard I of N; it is \"{}\"", max_parts, text);
    if (merges) throw bad_input("--shard makes a shard and --merge joins them; give one");
    return Shard{static_cast<int>(parts->first), static_cast<int>(parts->second)};
}

std::pair<long, long> frames_of_option(const std::string& text) {
    const auto range = two_numbers(text, ':');
    if (!range || range->first < 0 || range->second <= range->first)
        throw bad_input("--frames must be A:B with 0 ≤ A < B, the frames A to B−1; it is \"{}\"", text);
    return *range;
}

Rational seconds_of_option(const std::string& option, const std::string& text) {
    const auto seconds = parse_rational(text);
    if (!seconds || seconds->numerator < 0)
        throw bad_input("{} must be seconds ≥ 0, such as 6.8 or 1/3; it is \"{}\"", option, text);
    return *seconds;
}

void add_quality_option(CLI::App& command, std::string& quality) {
    add_value(command, "--quality", quality, "QUALITY",
              "draft: a quarter of the pixels; standard: as the preset; best: slow")
        ->check(CLI::IsMember(Choices{"draft", "standard", "best"}));
}

std::vector<Override> picture_overrides(const std::string& table, const std::string& size, const std::string& format,
                                        const std::string& quality) {
    std::vector<Override> all;
    const auto sides = two_numbers(size, 'x');
    if (sides) all.push_back({table + ".size", fmt::format("[{}, {}]", sides->first, sides->second), "--size " + size});
    if (!sides && !size.empty()) throw bad_input("--size must be WIDTHxHEIGHT, such as 1280x720; it is \"{}\"", size);
    if (!format.empty()) all.push_back({table + ".format", toml_text(format), "--format " + format});
    if (!quality.empty() && table != "video") throw bad_input("--quality is for films, and not for figures");
    const auto origin = "--quality " + quality;
    if (quality == "draft") all.push_back({"video.preview", "true", origin});
    if (quality == "best") all.insert(all.end(), {{"video.preset", "\"slow\"", origin}, {"video.crf", "14", origin}});
    return all;
}

void check_names(const std::vector<std::string>& names, const std::vector<std::string>& paths) {
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (names[i] == names[j])
                throw bad_input("{} and {} would both be written to {}/", paths[j], paths[i], names[i]);
}

std::vector<Override> overrides_of(const PresetOptions& options, const std::vector<Override>& more) {
    std::vector<Override> overrides;
    for (const auto& set : options.sets) overrides.push_back(parse_set(set));
    overrides.insert(overrides.end(), more.begin(), more.end());
    return overrides;
}

}  // namespace doppel

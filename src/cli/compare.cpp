#include "cli/commands.hpp"
#include "numeric/error.hpp"
#include "output/part_files.hpp"
#include "output/png.hpp"
#include "picture/golden.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <set>

namespace doppel {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
    std::string expected, actual, out = "out";
};

/// True if they pass; else says why and writes the difference picture.
bool same(const fs::path& expected_path, const fs::path& actual_path, const fs::path& out) {
    const auto expected = read_png(expected_path), actual = read_png(actual_path);
    if (expected.size != actual.size) {
        fmt::print("{}: differs from {}: {}×{} px, expected {}×{}\n", actual_path.string(), expected_path.string(),
                   actual.size.width, actual.size.height, expected.size.width, expected.size.height);
        return false;
    }
    const auto verdict = compare_golden(expected, actual);
    if (verdict.passes) return true;
    const auto name = actual_path.stem().string() + ".diff.png";
    PartFiles parts(out / "compare", name);
    write_png(parts.file(name), difference_picture(expected, actual));
    const auto files = parts.publish();
    fmt::print("{}: differs from {}: {}; expected, actual and difference ×16: {}\n", actual_path.string(),
               expected_path.string(), verdict.why, files.front().string());
    return false;
}

std::set<std::string> png_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".png") names.insert(entry.path().filename().string());
    return names;
}

bool same_folders(const fs::path& expected, const fs::path& actual, const fs::path& out) {
    const auto wanted = png_names(expected), found = png_names(actual);
    if (wanted.empty()) throw bad_input("{}: there is no PNG to compare with", expected.string());
    long differing = 0;
    const auto lacking = [&](const std::set<std::string>& from, const std::string& name, const fs::path& folder) {
        if (from.contains(name)) return false;
        fmt::print("{}: missing\n", (folder / name).string());
        ++differing;
        return true;
    };
    for (const auto& name : wanted)
        if (!lacking(found, name, actual)) differing += !same(expected / name, actual / name, out);
    for (const auto& name : found) lacking(wanted, name, expected);
    fmt::print("{} of {} pictures differ\n", differing, wanted.size());
    return differing == 0;
}

bool compare(const CompareOptions& options) {
    for (const auto& path : {options.expected, options.actual})
        if (!fs::exists(path)) throw bad_input("{}: there is no such file or folder", path);
    const bool folder = fs::is_directory(options.expected);
    if (folder != fs::is_directory(options.actual))
        throw bad_input("{} is a folder and {} is none; compare takes two pictures or two folders",
                        folder ? options.expected : options.actual, folder ? options.actual : options.expected);
    return folder ? same_folders(options.expected, options.actual, options.out)
                  : same(options.expected, options.actual, options.out);
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    auto& command =
        *app.add_subcommand("compare", "Golden comparison of two PNGs, or of two folders of them, name by name");
    command.footer(
        "Exit code 0: the same within the golden policy (a few pixels may differ a little, as between\n"
        "drivers); 1: they differ, and a picture of the difference was written to DIR/compare/.\n"
        "Example:\n  doppel render calm --format png --frames 0:3 && doppel compare golden out/calm/frames");
    command.add_option("EXPECTED", options->expected, "Picture or folder as it should be")->required();
    command.add_option("ACTUAL", options->actual, "Picture or folder as it is")->required();
    command.add_option("-o,--out", options->out, "Where difference pictures go: DIR/compare/")
        ->type_name("DIR")
        ->capture_default_str();
    command.callback([options, &exit_code] {
        if (!compare(*options)) exit_code = static_cast<int>(ExitCode::differs);
    });
}

}  // namespace doppel

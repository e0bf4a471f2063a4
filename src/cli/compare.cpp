#include "base/error.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "image/golden.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <set>

namespace doppel {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
    std::string expected, actual, out = "out";
};

fs::path folder_in(const fs::path& out) {
    return out / "compare";
}

/// Of the picture of that name.
std::string difference_name(const fs::path& actual) {
    return actual.stem().string() + ".diff.png";
}

constexpr const char* maker = "Doppel compare";  // of every difference picture

/// What an earlier comparison left, and it alone, is no news beside a picture that passes.
void remove_difference(const fs::path& folder, const std::string& name) {
    if (!fs::is_directory(folder)) return;
    const auto pictures = Folder::at(folder);
    if (maker_of_picture(pictures, name) == maker) pictures.remove(name);
}

/// True if they pass; else says why and writes the difference picture.
bool same(const fs::path& expected_path, const fs::path& actual_path, const fs::path& out) {
    const auto expected = read_png(expected_path), actual = read_png(actual_path);
    if (expected.size != actual.size) {
        print_line("{}: differs from {}: {}×{} px, expected {}×{}", actual_path.string(), expected_path.string(),
                   actual.size.width, actual.size.height, expected.size.width, expected.size.height);
        return false;
    }
    const auto verdict = compare_golden(expected, actual);
    const auto name = difference_name(actual_path);
    if (verdict.passes) {
        remove_difference(folder_in(out), name);
        return true;
    }
    Transaction parts(folder_in(out), name);
    write_png(parts.file(name), difference_picture(expected, actual), {.metadata = {{"encoder", maker}}});
    const auto files = parts.publish();
    print_line("{}: differs from {}: {}; expected, actual and difference ×16: {}", actual_path.string(),
               expected_path.string(), verdict.why, files.front().string());
    return false;
}

std::set<std::string> png_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".png") names.insert(entry.path().filename().string());
    return names;
}

/// Every picture that either folder has. One that cannot be compared does not keep the others from it; it is the error
/// at the end.
bool same_folders(const fs::path& expected, const fs::path& actual, const fs::path& out) {
    const auto wanted = png_names(expected), found = png_names(actual);
    if (wanted.empty()) throw bad_input("{}: there is no PNG to compare with", expected.string());
    auto names = wanted;
    names.insert(found.begin(), found.end());
    long differing = 0, failed = 0;
    std::optional<Error> first_fault;
    for (const auto& name : names) {
        if (!wanted.contains(name) || !found.contains(name)) {
            print_line("{}: missing", ((wanted.contains(name) ? actual : expected) / name).string());
            ++differing;
            continue;
        }
        try {
            differing += !same(expected / name, actual / name, out);
        } catch (const Error& fault) {
            print_line("{}", fault.what());
            ++failed;
            if (!first_fault) first_fault = fault;
        }
    }
    print_line("{} of {} pictures differ", differing, names.size());
    if (first_fault)
        throw Error(first_fault->code(), fmt::format("{} of {} pictures could not be compared; the first: {}", failed,
                                                     names.size(), first_fault->what()));
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

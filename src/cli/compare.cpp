#include "base/clock.hpp"
#include "base/error.hpp"
#include "cli/comparison.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "output/page.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
    std::string expected, actual, out = "out", junit, html;
};

fs::path folder_in(const fs::path& out) {
    return out / "compare";
}

/// The name of the difference picture of `actual`.
std::string difference_name(const fs::path& actual) {
    return actual.stem().string() + ".diff.png";
}

constexpr const char* maker = "Doppel compare";  // in the metadata of every difference picture

/// Removes an earlier difference picture of a picture that passes, and no other file.
void remove_difference(const fs::path& folder, const std::string& name) {
    if (std::error_code ignored; made_by(folder / name, maker)) fs::remove(folder / name, ignored);
}

/// Compares one pair. If it differs, stores the reason and writes the difference picture. Throws Error (exit 2, 4) if
/// a picture cannot be read.
void compare_pair(ComparedPicture& pair, const fs::path& out) {
    const auto expected = read_png(pair.expected), actual = read_png(pair.actual);
    pair.size = expected.size, pair.actual_size = actual.size;
    const auto [expected_path, actual_path] = std::pair(pair.expected.string(), pair.actual.string());
    if (expected.size != actual.size) {
        pair.match = Match::differs;
        pair.message = fmt::format("{}: differs from {}: {}×{} px, expected {}×{}", actual_path, expected_path,
                                   actual.size.width, actual.size.height, expected.size.width, expected.size.height);
        return;
    }
    pair.verdict = compare_golden(expected, actual);
    const auto name = difference_name(pair.actual);
    if (pair.verdict.passes) return remove_difference(folder_in(out), name);
    pair.match = Match::differs;
    Transaction parts(folder_in(out), name, {}, {.inputs = {pair.expected, pair.actual}});
    const auto place = parts.file(name);
    if (const auto older = parts.folder() / name; fs::exists(older) && !made_by(older, maker))
        throw io_failed("{} is no difference picture; move it, or give another folder with --out", older.string());
    write_png(place, difference_picture(expected, actual), {.metadata = {{"encoder", maker}}});
    const auto files = parts.publish();
    pair.message = fmt::format("{}: differs from {}: {}; expected, actual and difference ×16: {}", actual_path,
                               expected_path, pair.verdict.why, files.front().string());
}

/// Like compare_pair(), with the time. Stores the error of an unreadable picture in `first_fault` if it
/// is the first.
ComparedPicture compared(ComparedPicture pair, const fs::path& out, std::optional<Error>& first_fault) {
    const double start = seconds_of(CLOCK_MONOTONIC);
    try {
        compare_pair(pair, out);
    } catch (const Error& fault) {
        pair.match = Match::unreadable;
        pair.message = fault.what();
        if (!first_fault) first_fault = fault;
    }
    pair.seconds = seconds_of(CLOCK_MONOTONIC) - start;
    return pair;
}

std::set<std::string> png_names(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& name : names_in(folder))
        if (fs::path(name).extension() == ".png") names.insert(name);
    return names;
}

/// Compares every picture in either folder. An unreadable picture does not stop the comparison.
void compare_folders(Comparison& comparison, const fs::path& out, std::optional<Error>& first_fault) {
    const fs::path expected = comparison.expected, actual = comparison.actual;
    const auto wanted = png_names(expected), found = png_names(actual);
    if (wanted.empty()) throw bad_input("{}: there is no PNG to compare with", expected.string());
    auto names = wanted;
    names.insert(found.begin(), found.end());
    for (const auto& name : names) {
        ComparedPicture pair{.name = name, .expected = expected / name, .actual = actual / name};
        if (wanted.contains(name) && found.contains(name)) {
            pair = compared(std::move(pair), out, first_fault);
        } else {
            pair.match = Match::missing;
            pair.message = fmt::format("{}: missing", (wanted.contains(name) ? pair.actual : pair.expected).string());
        }
        if (!pair.message.empty()) print_line("{}", pair.message);
        comparison.pictures.push_back(std::move(pair));
    }
    print_line("{}", comparison.summary());
}

/// A requested report. Reserves its path before the work, so that an error is reported at once.
/// `start`: the first bytes of such a report, which identify an older one.
std::optional<SingleFile> place_of_report(const std::string& file, std::string_view start) {
    if (file.empty()) return std::nullopt;
    if (!fs::path(file).has_filename()) throw bad_input("{}: a report is a file, not a folder", file);
    return std::optional<SingleFile>(std::in_place, file, start);
}

/// Returns whether all pictures pass. Throws Error if some could not be read, after writing the reports.
bool compare(const CompareOptions& options) {
    std::error_code fault;
    for (const auto& path : {options.expected, options.actual})
        if (!fs::exists(path, fault))
            throw fault ? cannot(path, "read", fault.value()) : bad_input("{}: there is no such file or folder", path);
    const bool folders = fs::is_directory(options.expected, fault);
    if (folders != fs::is_directory(options.actual, fault))
        throw bad_input("{} is a folder and {} is none; compare takes two pictures or two folders",
                        folders ? options.expected : options.actual, folders ? options.actual : options.expected);
    const auto is_one_file = fs::path(options.junit).lexically_normal() == fs::path(options.html).lexically_normal();
    if (is_one_file && !options.html.empty()) throw bad_input("--junit and --html would both write {}", options.html);
    const auto junit = place_of_report(options.junit, junit_start);
    const auto html = place_of_report(options.html, page_start("compare"));
    Comparison comparison{options.expected, options.actual, {}};
    std::optional<Error> first_fault;
    if (folders) {
        compare_folders(comparison, options.out, first_fault);
    } else {
        const fs::path expected = options.expected, actual = options.actual;
        ComparedPicture pair{.name = actual.filename().string(), .expected = expected, .actual = actual};
        pair = compared(std::move(pair), options.out, first_fault);
        if (pair.match == Match::differs) print_line("{}", pair.message);
        comparison.pictures.push_back(std::move(pair));
    }
    if (junit) write_junit(junit->place(), comparison);
    if (html) write_compare_page(html->place(), comparison);
    for (const auto* report : {&junit, &html})
        if (*report) (*report)->publish();
    if (!first_fault) return comparison.count(Match::passes) == std::ssize(comparison.pictures);
    if (!folders) throw Error(*first_fault);
    throw Error(first_fault->code(),
                fmt::format("{} of {} pictures could not be compared; the first: {}",
                            comparison.count(Match::unreadable), comparison.pictures.size(), first_fault->what()));
}

}  // namespace

long Comparison::count(Match match) const {
    return std::ranges::count(pictures, match, &ComparedPicture::match);
}

std::string Comparison::summary() const {
    return fmt::format("{} of {} pictures differ", count(Match::differs) + count(Match::missing), pictures.size());
}

void add_compare(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    auto& command = *app.add_subcommand("compare", "Compares two PNGs, or two folders of them, with the golden policy");
    command.footer(
        "Exit code 0: the same within the golden policy (a few pixels may differ a little, as between\n"
        "drivers); 1: they differ, and a picture of the difference was written to DIR/compare/.\n"
        "Example:\n  doppel render calm --format png --frames 0:3 && doppel compare golden out/calm/frames");
    command.add_option("EXPECTED", options->expected, "Picture or folder as it should be")->required();
    command.add_option("ACTUAL", options->actual, "Picture or folder as it is")->required();
    refuse_dash(command.add_option("-o,--out", options->out, "Where difference pictures go: DIR/compare/"))
        ->type_name("DIR")
        ->capture_default_str();
    refuse_dash(command.add_option("--junit", options->junit, "Also writes a report for test servers: JUnit's XML"))
        ->type_name("FILE");
    refuse_dash(command.add_option("--html", options->html,
                                   "Also writes a page of what differs: expected, actual, difference, slider"))
        ->type_name("FILE");
    command.callback([options, &exit_code] {
        if (!compare(*options)) exit_code = static_cast<int>(ExitCode::differs);
    });
}

}  // namespace doppel

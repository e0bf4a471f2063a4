#include "base/error.hpp"
#include "base/machine.hpp"
#include "base/read_file.hpp"
#include "cli/comparison.hpp"
#include "cli/options.hpp"
#include "figure/run.hpp"
#include "film/film.hpp"
#include "output/page.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

struct CompareOptions : PresetOptions {
    std::string expected, actual, out = "out", junit, html;
    std::string render, at, frames, size;
    Gl gl = Gl::automatic;
    bool update = false, list_outputs = false;
};

/// What becomes of pictures that differ.
struct Task {
    fs::path folder;        // of the difference pictures
    bool is_drawn = false;  // the actual pictures are temporary; those that differ are kept in `folder`
    bool updates = false;   // they become the goldens
    const std::atomic<bool>& stop = never_stopped;
};

constexpr const char* maker = "Doppel compare";  // in the metadata of every difference picture

/// The PNGs of a folder; none if it does not exist.
std::set<std::string> png_names(const fs::path& folder) {
    std::set<std::string> names;
    if (std::error_code ignored; !fs::exists(folder, ignored)) return names;
    for (const auto& name : names_in(folder))
        if (fs::path(name).extension() == ".png") names.insert(name);
    return names;
}

/// "frame" of "frame.png" and of its variant "frame.egl.png".
std::string base_of(const fs::path& name) {
    return name.stem().stem().string();
}

/// The PNGs of a folder as goldens of the pictures NAME.png: each the golden of its own name, or the variant
/// NAME.VARIANT.png of one that is there or among `drawn`. Those of `drawn` without a golden are included.
std::map<std::string, std::vector<fs::path>> goldens_in(const fs::path& folder, const std::set<std::string>& drawn) {
    const auto names = png_names(folder.empty() ? "." : folder);
    std::map<std::string, std::vector<fs::path>> goldens;
    for (const auto& name : drawn) goldens[name];
    for (const auto& name : names) {
        const auto base = base_of(name) + ".png";
        const bool is_variant = !drawn.contains(name) && (names.contains(base) || drawn.contains(base));
        auto& all = goldens[is_variant ? base : name];
        all.insert(is_variant ? all.end() : all.begin(), folder / name);
    }
    return goldens;
}

/// Finds the golden that the picture matches, or else the nearest one, and returns its pixels.
Picture nearest_golden(ComparedPicture& pair, const Picture& actual) {
    Picture nearest;
    std::optional<std::tuple<bool, bool, long, double>> least;
    pair.actual_size = actual.size;
    pair.match = pair.goldens.empty() ? Match::missing : Match::differs;
    for (const auto& golden : pair.goldens) {
        auto expected = read_png(golden);
        const bool same_size = expected.size == actual.size;
        const auto verdict = same_size ? compare_golden(expected, actual) : GoldenVerdict();
        const bool passes = same_size && verdict.passes;
        const std::tuple distance(!passes, !same_size, verdict.strong, verdict.worst_tile);
        if (least && *least <= distance) continue;
        least = distance;
        pair.expected = golden, pair.size = expected.size, pair.verdict = verdict;
        nearest = std::move(expected);
        if (!passes) continue;
        pair.match = Match::passes;
        break;
    }
    return nearest;
}

void copy_picture(const fs::path& from, const fs::path& to) {
    write_file(to, read_whole_file(from, png_file));
}

/// Makes the drawn picture the golden NAME.png; variants stay. Throws Error (exit 4).
void update_golden(ComparedPicture& pair, const fs::path& golden) {
    const bool is_new = type_of(golden) == fs::file_type::not_found;
    if (!is_new && !made_by(golden))
        throw io_failed("{} is no PNG of Doppel; move it, or give another place for the golden", golden.string());
    SingleFile file(golden, "");
    copy_picture(pair.actual, file.place);
    file.parts.publish();
    pair.match = Match::passes;
    pair.message = fmt::format("{}: {}", golden.string(), is_new ? "new" : "updated");
    for (const auto& variant : pair.goldens)
        if (variant != golden) pair.message += fmt::format("; {} stays as it was", variant.string());
}

/// "OUT/compare/NAME.diff.png" and so on.
fs::path place_of(const ComparedPicture& pair, const Task& task, std::string_view ending) {
    return task.folder / fs::path(pair.name).stem().concat(ending);
}

/// Writes the difference picture if there is an `expected` one, and keeps a drawn picture.
void write_difference(ComparedPicture& pair, const Picture* expected, const Picture& actual, const Task& task) {
    const auto difference = place_of(pair, task, ".diff.png"), kept = place_of(pair, task, ".actual.png");
    Transaction parts(task.folder, difference.filename(), {}, {.inputs = {pair.expected, pair.actual}});
    if (expected) {
        const auto place = parts.file(difference.filename());
        if (fs::exists(difference) && !made_by(difference, maker))
            throw io_failed("{} is no difference picture; move it, or give another folder with --out",
                            difference.string());
        write_png(place, difference_picture(*expected, actual), {.metadata = {{"encoder", maker}}});
    }
    if (task.is_drawn) copy_picture(std::exchange(pair.actual, kept), parts.file(kept.filename()));
    parts.publish();
}

/// Removes what an earlier comparison wrote about a picture that passes, and no other file.
void remove_difference(const ComparedPicture& pair, const Task& task) {
    std::error_code ignored;
    if (const auto path = place_of(pair, task, ".diff.png"); made_by(path, maker)) fs::remove(path, ignored);
    if (const auto path = place_of(pair, task, ".actual.png"); task.is_drawn && made_by(path))
        fs::remove(path, ignored);
}

/// Compares a picture with its goldens. Throws Error (exit 2, 4) if one cannot be read.
void compare_pair(ComparedPicture& pair, const Task& task) {
    const auto golden = pair.expected;
    const auto actual = read_png(pair.actual);
    const auto expected = nearest_golden(pair, actual);
    if (pair.match == Match::passes) {
        if (pair.expected != golden) pair.message = fmt::format("{}: matches {}", pair.name, pair.expected.string());
        return remove_difference(pair, task);
    }
    if (task.updates) return update_golden(pair, golden);
    const bool same_size = expected.size == actual.size;
    if (same_size || task.is_drawn) write_difference(pair, same_size ? &expected : nullptr, actual, task);
    if (pair.match == Match::missing) {
        pair.message = fmt::format("{}: missing; drawn now: {}; --update makes it the golden", golden.string(),
                                   pair.actual.string());
        return;
    }
    const auto count = pair.goldens.size();
    pair.message = fmt::format("{}: differs from {}{}: ", pair.actual.string(), pair.expected.string(),
                               count > 1 ? fmt::format(", the nearest of {}", count) : "");
    pair.message += same_size ? fmt::format("{}; expected, actual and difference ×16: {}", pair.verdict.why,
                                            place_of(pair, task, ".diff.png").string())
                              : fmt::format("{}×{} px, expected {}×{}", actual.size.width, actual.size.height,
                                            expected.size.width, expected.size.height);
}

/// Compares the pictures and prints what is found. An unreadable picture does not stop this; the error of the first one
/// is returned.
std::optional<Error> compare_all(Comparison& comparison, const Task& task, bool are_folders) {
    std::optional<Error> first_fault;
    for (auto& pair : comparison.pictures) {
        throw_if_set(task.stop);
        const double start = seconds_of(CLOCK_MONOTONIC);
        try {
            if (pair.match != Match::missing) compare_pair(pair, task);
        } catch (const Error& fault) {
            pair.match = Match::unreadable;
            pair.message = fault.what();
            if (!first_fault) first_fault = fault;
        }
        pair.seconds = seconds_of(CLOCK_MONOTONIC) - start;
        const bool is_thrown = pair.match == Match::unreadable && !are_folders;
        if (!pair.message.empty() && !is_thrown) print_line("{}", pair.message);
    }
    if (are_folders) print_line("{}", comparison.summary());
    return first_fault;
}

/// Every picture in either folder; those that cannot be compared are missing.
std::vector<ComparedPicture> pairs_of(const fs::path& expected, const fs::path& actual, bool is_drawn) {
    const auto found = png_names(actual);
    if (png_names(expected).empty() && !is_drawn)
        throw bad_input("{}: there is no PNG to compare with", expected.string());
    if (!is_drawn)
        for (const auto& name : names_in(expected))
            if (fs::is_directory(expected / name))
                print_line("{}: this folder is not compared; name it to compare it", (expected / name).string());
    std::vector<ComparedPicture> pairs;
    for (const auto& [name, all] : goldens_in(expected, found)) {
        auto& pair = pairs.emplace_back(
            ComparedPicture{.name = name, .expected = expected / name, .actual = actual / name, .goldens = all});
        if (found.contains(name) && (is_drawn || !all.empty())) continue;
        pair.match = Match::missing;
        pair.message = is_drawn ? fmt::format("{}: there is no such frame", pair.expected.string())
                                : fmt::format("{}: missing", (all.empty() ? pair.expected : pair.actual).string());
    }
    return pairs;
}

/// A picture, and the golden for it with its variants.
ComparedPicture pair_of(const fs::path& expected, const fs::path& actual) {
    const fs::path name = expected.filename();
    ComparedPicture pair{.name = actual.filename(), .expected = expected, .actual = actual, .goldens = {expected}};
    auto goldens = goldens_in(expected.parent_path(), {name});
    for (const auto& variant : goldens[name])
        if (variant.filename() != name && !fs::equivalent(variant, actual)) pair.goldens.push_back(variant);
    return pair;
}

/// A picture NAME to draw, and its goldens: EXPECTED, or in the folder EXPECTED.
ComparedPicture single_picture(const CompareOptions& options, const std::string& name) {
    std::error_code ignored;
    const fs::path expected = options.expected;
    const bool is_folder = fs::is_directory(expected, ignored) || expected.extension() != ".png";
    const auto golden = is_folder ? expected / name : expected;
    const std::string file = golden.filename();
    return {.name = file, .expected = golden, .actual = {}, .goldens = goldens_in(golden.parent_path(), {file})[file]};
}

/// The frames to draw: those whose numbers goldens have, and those of --frames.
std::vector<long> frame_numbers(const Scene& scene, const CompareOptions& options) {
    std::set<std::string> goldens;
    for (const auto& name : png_names(options.expected)) goldens.insert(base_of(name));
    const auto schedule = schedule_of(scene);
    FrameRange wanted{0, 0};
    if (!options.frames.empty()) {
        const auto [first, last] = frames_of_option(options.frames);
        check_run(scene, {.first = first, .last = last});
        wanted = schedule.range(first, last);
    }
    std::vector<long> numbers;
    for (long number = 0; number < schedule.frames(); ++number)
        if (wanted.contains(number) || goldens.contains(fmt::format("{:06}", number))) numbers.push_back(number);
    return numbers;
}

/// Draws frames of a film as `render --format png` does. Returns their folder.
fs::path draw_frames(const Scene& scene, const CompareOptions& options, RunOptions run_options, const Task& task,
                     const Report& report) {
    if (std::error_code ignored; fs::is_regular_file(options.expected, ignored))
        throw bad_input("{} is a picture; give its time with --at, or a folder of frames", options.expected);
    run_options.only = frame_numbers(scene, options);
    if (run_options.only.empty())
        throw bad_input("{}: there is no golden frame such as 000000.png; --frames 0:1 --update makes one",
                        options.expected);
    return run(scene, run_options, task.stop, report).files.front();
}

/// Draws in a folder what is compared with the goldens. Throws Error as render and figure do.
std::vector<ComparedPicture> draw(const CompareOptions& options, const PresetText& text, const fs::path& folder,
                                  const Task& task) {
    const bool is_chart = is_figure(text);
    const std::string table = is_chart ? "chart" : "video";
    auto overrides = overrides_of(options, picture_overrides(table, options.size));
    overrides.push_back({table + ".format", "\"png\"", "--render, which draws PNG"});
    if (is_chart && !(options.at + options.frames).empty())
        throw bad_input("--at and --frames are for films; {} is a figure", text.name);
    ProgressReport progress(ProgressStyle::automatic, text.name, is_chart ? "trials" : "frames");
    const Report report = std::ref(progress);
    const Replacing replacing{.is_temporary = true};
    const RunOptions run_options{.out = folder, .gl = options.gl, .replacing = replacing};
    std::vector<ComparedPicture> pairs;
    if (is_chart) {
        const auto figure = read_figure(text, overrides, task.stop);
        const auto file = figure.name + ".png";
        pairs = {single_picture(options, file)};
        const auto tell = [&](std::size_t, const FigureProgress& now) {
            report({std::lround(now.done), std::lround(now.total)});
        };
        run_figures({figure}, {.out = folder, .replacing = replacing}, task.stop, {.progress = tell});
        pairs.front().actual = folder / figure.name / file;
    } else {
        auto scene = make_scene(read_preset(text, overrides), task.stop);
        scene.preset.video.poster_s.reset();
        if (options.at.empty()) {
            pairs = pairs_of(options.expected, draw_frames(scene, options, run_options, task, report), true);
        } else {
            const auto at = seconds_of_option("--at", options.at);
            pairs = {single_picture(options, still_name(scene, at, PictureFormat::png))};
            const auto drawn = draw_still(scene, at, PictureFormat::png, run_options, task.stop, report);
            pairs.front().actual = drawn.files.front();
        }
    }
    progress.clear();
    return pairs;
}

/// Throws Error (exit 2) if the arguments do not belong together.
void check_arguments(const CompareOptions& options) {
    const char* const ci = std::getenv("CI");
    if (options.update && ci && *ci != 0 && std::string_view(ci) != "false")
        throw bad_input("--update: goldens are made by a person who looks at them, not by CI; CI is set to \"{}\"", ci);
    const auto is_one_file = fs::path(options.junit).lexically_normal() == fs::path(options.html).lexically_normal();
    if (is_one_file && !options.html.empty()) throw bad_input("--junit and --html would both write {}", options.html);
    if (options.actual.empty() == options.render.empty())
        throw bad_input("compare needs EXPECTED and ACTUAL, or --render PRESET and EXPECTED");
}

/// Throws Error (exit 2, 4) if what is compared is not there.
void check_paths(const CompareOptions& options) {
    std::error_code fault;
    const bool is_drawn = !options.render.empty();  // then goldens may be missing
    for (const auto& path : {options.expected, options.actual})
        if (!fs::exists(path, fault) && (fault || !is_drawn))
            throw fault ? cannot(path, "read", fault.value()) : bad_input("{}: there is no such file or folder", path);
    const bool folders = fs::is_directory(options.expected, fault);
    if (!is_drawn && folders != fs::is_directory(options.actual, fault))
        throw bad_input("{} is a folder and {} is none; compare takes two pictures or two folders",
                        folders ? options.expected : options.actual, folders ? options.actual : options.expected);
}

/// Returns whether all pictures pass. Throws Error if some could not be read, after writing the reports.
bool compare(const CompareOptions& options) {
    check_arguments(options);
    if (options.list_outputs) {
        check_paths(options);
        for (const auto& report : {options.junit, options.html})
            if (!report.empty()) print_line("{}", report);
        return true;
    }
    // reserved before the work, so that an error is reported at once
    std::optional<SingleFile> junit, html;
    if (!options.junit.empty()) junit.emplace(options.junit, junit_start);
    if (!options.html.empty()) html.emplace(options.html, page_start("compare"));
    Comparison comparison{options.expected, options.render + options.actual, {}};
    Task task{fs::path(options.out) / "compare", !options.render.empty(), options.update,
              options.render.empty() ? never_stopped : watch_interrupts()};
    std::optional<TemporaryFolder> drawn;
    std::error_code missing;
    bool are_folders = fs::is_directory(options.actual, missing);
    std::optional<Error> first_fault;
    try {
        check_paths(options);
        if (task.is_drawn) {
            const auto preset = find_preset(options.render, &task.stop);
            task.folder = fs::path(options.out) / preset.name / "compare";
            are_folders = !is_figure(preset) && options.at.empty();
            comparison.pictures = draw(options, preset, drawn.emplace().path(), task);
        } else {
            comparison.pictures = are_folders ? pairs_of(options.expected, options.actual, false)
                                              : std::vector{pair_of(options.expected, options.actual)};
        }
        first_fault = compare_all(comparison, task, are_folders);
    } catch (const Error& fault) {
        if (fault.code() == ExitCode::interrupted) throw;
        first_fault = fault;
        are_folders = false;
        comparison.pictures = {{.name = comparison.actual, .match = Match::unreadable, .message = fault.what()}};
    }
    if (junit) write_junit(junit->place, comparison);
    if (html) write_compare_page(html->place, comparison);
    for (auto* report : {&junit, &html})
        if (*report) (*report)->parts.publish();
    if (!first_fault) return comparison.count(Match::passes) == std::ssize(comparison.pictures);
    if (!are_folders) throw Error(*first_fault);
    throw Error(first_fault->code(),
                fmt::format("{} of {} pictures could not be compared; the first: {}",
                            comparison.count(Match::unreadable), comparison.pictures.size(), first_fault->what()));
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    auto& command = *app.add_subcommand("compare", "Compares PNGs, or draws and compares them, with the golden policy");
    command.footer(
        "Exit code 0: the same within the golden policy (a few pixels may differ a little, as between\n"
        "drivers); 1: they differ. If their sizes agree, a picture of the difference is in DIR/compare/,\n"
        "with --render in DIR/NAME/compare/ beside the drawn picture. A picture NAME.png may have variants,\n"
        "NAME.VARIANT.png: it passes if it matches one of them.\n"
        "Examples:\n"
        "  doppel compare golden out/calm/frames\n"
        "  doppel compare --render calm golden/calm --frames 0:3 --update    makes the goldens\n"
        "  doppel compare --render calm golden/calm                          draws and compares\n"
        "  doppel compare --render calm golden/calm.14s.png --at 14\n"
        "  doppel compare --render fig6 golden");
    command.add_option("EXPECTED", options->expected, "Picture or folder as it should be")->required();
    command.add_option("ACTUAL", options->actual, "Picture or folder as it is");
    auto* const render = add_value(command, "--render", options->render, "PRESET",
                                   "Draw it: the frames whose numbers are in EXPECTED, or a figure");
    add_value(command, "--at", options->at, "SECONDS", "Draw the picture at this time, as still does")->needs(render);
    add_value(command, "--frames", options->frames, "A:B", "Draw the frames A to B-1, too")
        ->needs(render)
        ->excludes("--at");
    add_set_option(command, *options)->needs(render);
    add_value(command, "--size", options->size, "WxH", "Size of the picture, px")->needs(render);
    add_gl_option(command, options->gl)->needs(render);
    command.add_flag("--update", options->update, "Replace the goldens that differ; refused if CI is set")
        ->needs(render);
    refuse_dash(add_value(command, "-o,--out", options->out, "DIR", "Where difference pictures go"))
        ->capture_default_str();
    refuse_dash(
        add_value(command, "--junit", options->junit, "FILE", "Also write a report for test servers: JUnit's XML"));
    refuse_dash(add_value(command, "--html", options->html, "FILE",
                          "Also write a page of what differs: expected, actual, difference, slider"));
    command.add_flag("--list-outputs", options->list_outputs, "Only list the reports that would be written");
    command.callback([options, &exit_code] {
        if (!compare(*options)) exit_code = static_cast<int>(ExitCode::differs);
    });
}

}  // namespace doppel

#include "base/error.hpp"
#include "cli/options.hpp"
#include "figure/page.hpp"
#include "figure/run.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace doppel {
namespace {

struct FigureCommandOptions : RunCommandOptions {
    std::string size, format, shard;
    double scale = 0;
    bool merge = false, tiles = false;
};

std::vector<Override> overrides(const FigureCommandOptions& options) {
    auto all = overrides_of(options, picture_overrides("chart", options.size, options.format));
    if (options.scale != 0)
        all.push_back({"chart.scale", fmt::format("{}", options.scale), fmt::format("--scale {}", options.scale)});
    return all;
}

/// "all" means every built-in figure.
std::vector<PresetText> chosen_presets(const FigureCommandOptions& options) {
    std::vector<PresetText> chosen;
    for (const auto& name : options.presets) {
        if (name != "all") {
            chosen.push_back(find_preset(name, &watch_interrupts()));
            continue;
        }
        for (const auto& preset : builtin_presets())
            if (is_figure(preset)) chosen.push_back(preset);
    }
    std::vector<std::string> names, paths;
    for (const auto& preset : chosen) names.push_back(preset.name), paths.push_back(preset.path);
    check_names(names, paths);
    return chosen;
}

void make_figures(const FigureCommandOptions& options) {
    std::vector<FigurePreset> figures;
    Replacing replacing{.force = options.force, .is_temporary = options.out == "-"};
    for (const auto& preset : chosen_presets(options)) {
        figures.push_back(read_figure(preset, overrides(options), watch_interrupts()));
        replacing.inputs.emplace_back(preset.path);
    }
    if (options.tiles) {
        for (const auto& figure : figures) require_map(figure);
        constexpr std::array<std::string_view, 3> of_page{"chart.theme", "chart.title", "chart.captions"};
        for (const auto& [key, value, origin] : overrides(options))
            if (key.starts_with("chart.") && std::ranges::count(of_page, key) == 0)
                throw bad_input("{}: is for a picture; --tiles writes PNGs of one pixel a cell", origin);
    }
    if (options.out == "-" && (options.tiles || options.merge || !options.shard.empty()))
        throw bad_input("-o -: standard output takes one picture, and no {}", options.tiles ? "tiles"
                                                                              : options.merge
                                                                                  ? "merge of parts in a folder"
                                                                                  : "part for a merge");
    FigureOptions run{.jobs = options.jobs,
                      .shard = shard_of_option(options.shard, options.merge),
                      .merge = options.merge,
                      .tiles = options.tiles,
                      .replacing = std::move(replacing)};
    const Destination to(options, figures.size(), fmt::format(".{}", name_of(figures.front().chart.format)));
    if (options.list_outputs) {
        for (const auto& figure : figures) list_outputs(options, figure.name, figure_files(figure, run));
        return;
    }
    run.out = to.folder;
    // the computation of one figure may overlap with the drawing of another
    std::mutex mutex;
    std::vector<std::optional<ProgressReport>> reports(figures.size());
    const auto tell = [&](std::size_t k, const auto& what) {
        const std::lock_guard lock(mutex);
        if (!reports[k])
            reports[k].emplace(options.progress, figures[k].name, figures[k].experiment->unit(), to.streamed);
        what(*reports[k]);
    };
    ignore_sigpipe();
    run_figures(
        figures, run, watch_interrupts(),
        {[&](std::size_t k, const FigureProgress& progress) {
             tell(k, [&](auto& report) { report({std::lround(progress.done), std::lround(progress.total)}); });
         },
         [&](std::size_t k, const std::string& sentence) { tell(k, [&](auto& report) { report.note(sentence); }); },
         [&](std::size_t k, const RunResult& result) { tell(k, [&](auto& report) { report.done(result); }); }});
}

}  // namespace

void add_figure(CLI::App& app) {
    auto options = std::make_shared<FigureCommandOptions>();
    auto& command =
        *app.add_subcommand("figure", "Draws figures: PNG, PDF, SVG or HTML, CSV, manifest; \"all\" draws every one");
    command.footer(
        "Examples:\n"
        "  doppel figure fig2-right --set grid.right=exponent\n"
        "  doppel figure fig2-right -o - > fig2-right.png\n"
        "  doppel figure all --out figures --scale 2\n"
        "  doppel figure fig2-right --format pdf --set chart.width_cm=8.6\n"
        "  doppel figure fig2-right --format html    # point at a curve to read its numbers\n"
        "  doppel figure flip-map --shard 3/8        # a part, on one of eight machines\n"
        "  doppel figure flip-map --merge            # all parts in DIR/flip-map/ together\n"
        "  doppel figure flip-map --tiles --set grid.x.points=8192 --set grid.y.points=8192\n"
        "The same command resumes an interrupted figure.");
    add_run_options(command, *options, "Threads; default: one a core; same numbers for any N");
    add_value(command, "--size", options->size, "WxH", "Size of the layout, px");
    add_value(command, "--format", options->format, "FORMAT",
              "Format of the picture; html: a page that tells the numbers")
        ->check(CLI::IsMember(Choices{names_of<PictureFormat>.begin(), names_of<PictureFormat>.end()}));
    add_value(command, "--scale", options->scale, "N", "Scale: 2 draws four pixels for each pixel of the layout")
        ->check(CLI::Range(0.25, 8.0));
    add_value(command, "--shard", options->shard, "I/N", "Compute shard I of N only, for --merge");
    command.add_flag("--merge", options->merge, "Join the parts in DIR/NAME/ into the figure");
    command.add_flag("--tiles", options->tiles,
                     "Of a map: tiles, one pixel a cell, and a page to pan and zoom, NAME.html");
    command.callback([options] { make_figures(*options); });
}

}  // namespace doppel

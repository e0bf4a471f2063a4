#include "base/error.hpp"
#include "cli/options.hpp"
#include "fit/result.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace doppel {

template <>
inline constexpr auto names_of<Bodies> = std::to_array<std::string_view>({"auto", "point", "rigid"});

namespace {

struct FitCommandOptions : OutOptions {
    std::vector<std::string> tracks;
    double every_s = 0;
    FitOptions fit;
};

void fit(const FitCommandOptions& options) {
    auto fit_options = options.fit;
    fit_options.out = options.out;
    fit_options.force = options.force;
    if (options.every_s > 0) fit_options.every_s = options.every_s;
    ignore_sigpipe();
    const std::vector<std::filesystem::path> files(options.tracks.begin(), options.tracks.end());
    const auto name = fit_name(files, fit_options);
    if (options.list_outputs)
        return list_outputs(options, name,
                            {name + ".toml", name + ".residuals.csv", name + ".png", name + ".fit.json"});
    ProgressReport report(options.progress, name, "models");
    const auto done = run_fit(files, fit_options, watch_interrupts(), std::ref(report));
    for (const auto& sentence : done.sentences) report.note(sentence);
    report.done(done.run);
}

}  // namespace

void add_fit(CLI::App& app) {
    auto options = std::make_shared<FitCommandOptions>();
    auto& command =
        *app.add_subcommand("fit", "Fits a double pendulum to a track: parameters, errors, prediction horizon");
    command.footer(
        "A track is a CSV with time_s and the angles theta1_rad, theta2_rad from the downward vertical, or\n"
        "places in a picture: x0_px, y0_px, x1_px, y1_px, x2_px, y2_px (pivot, joint, end; y down).\n"
        "It may have any rate, gaps, and several pieces. Nine models are fitted, from point masses\n"
        "without friction to bodies with friction and drag. The smallest is chosen that predicts pieces\n"
        "left out as well as the best. DIR/NAME/ gets a preset (NAME.toml), all numbers (NAME.fit.json),\n"
        "NAME.residuals.csv and a page (NAME.png).\n"
        "Examples:\n"
        "  doppel fit swing.csv\n"
        "  doppel fit piece-*.csv --name lab --out fits\n"
        "  doppel fit piece-*.csv --every 5.334      each with a clock of its own, so many seconds apart\n"
        "  doppel fit swing.csv --gravity 9.81 --mass 0.138");
    command.add_option("TRACK", options->tracks, "CSV files, in the order of time")->required();
    add_choice(command, "--model", options->fit.bodies, "KIND",
               "Bodies: auto, point (masses on massless rods) or rigid (bodies)");
    add_value(command, "--name", options->fit.name, "NAME", "Name of the results; default: that of the first file");
    add_value(command, "--every", options->every_s, "S", "Seconds from the beginning of a piece to that of the next")
        ->check(CLI::Range(1e-3, 1e6));
    add_value(command, "--gravity", options->fit.convention.gravity, "G",
              "Gravity of the preset, m/s²; angles do not determine it")
        ->check(CLI::Range(1e-3, 1e4))
        ->capture_default_str();
    add_value(command, "--mass", options->fit.convention.second_mass, "KG",
              "Mass of the second link in the preset, kg; angles do not determine it")
        ->check(CLI::Range(1e-9, 1e9))
        ->capture_default_str();
    add_out_options(command, *options);
    refuse_dash(command.get_option("--out"))->description("Folder for the results, DIR/NAME/");
    add_value(command, "-j,--jobs", options->fit.jobs, "N", "Threads; default: one a core; same numbers for any N")
        ->check(CLI::Range(1, 1024));
    command.callback([options] { fit(*options); });
}

}  // namespace doppel

#include "base/error.hpp"
#include "base/machine.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"
#include "output/csv.hpp"
#include "output/transaction.hpp"
#include "scene/certificate.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <memory>

namespace doppel {
namespace {

struct CertifyOptions : RunCommandOptions {
    double radius = usual_run_radius;  // rad

    CertifyOptions() { wants_proof = false; }  // it makes its own
};

std::vector<std::string> certified_files(const std::string& name) {
    return {name + ".certified.csv", name + ".certified.json"};
}

void write_rows(const Scene& scene, const Certificate& proved, const std::filesystem::path& place) {
    std::vector<std::string> columns{"sample", "time_s"};
    const auto add = [&](const std::string& number) {
        columns.insert(columns.end(), {number + "_low", number + "_high"});
    };
    for (const char letter : scene.letters())
        for (const char* number : {"theta1_rad", "theta2_rad", "omega1_rad_per_s", "omega2_rad_per_s"})
            add(fmt::format("{}_{}", letter, number));
    if (!scene.is_single()) add("distance");
    Csv table(place, columns);
    for (long n = 0; n <= proved.last(); ++n) {
        table.add(n);
        table.add(scene.time(n));
        for (const auto& [low, high] : proved.rows[static_cast<std::size_t>(n)].bounds) {
            table.add(low);
            table.add(high);
        }
        table.end_row();
    }
    table.finish();
}

/// Writes what is proved and reports it. Throws Error (exit 3) if that is not all.
void certify(const Scene& scene, const CertifyOptions& options, const std::filesystem::path& out,
             ProgressReport& report) {
    const double wall_start = seconds_of(CLOCK_MONOTONIC), cpu_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const auto& stop = watch_interrupts();
    const auto& name = scene.preset.name;
    const auto files = certified_files(name);
    Transaction parts(out / name, "certify", "certificate", {inputs_of(options.presets, {scene}), options.force});
    parts.require(files[1]);
    const auto place = parts.file(files[0]);
    const auto proved = certificate_of(scene, options.radius, options.jobs > 0 ? options.jobs : cores(), stop,
                                       std::bind_front(&ProgressReport::of_proof, &report));
    write_rows(scene, proved, place);
    parts.finished(files[0]);
    RunResult result{.samples = proved.last() + 1, .wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start};
    write_manifest(
        parts, files[1],
        {{"doppel", program_json()},
         {"preset", name},
         {"resolved_preset", json_of_toml(resolved_toml(scene.preset))},
         {"samples", {{"first", 0}, {"last", proved.last()}, {"of", scene.samples}}},
         {"certificate", certificate_json(scene, proved)},
         {"time", {{"wall_s", result.wall_s}, {"cpu_s", seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start}}}});
    throw_if_set(stop);
    result.files = parts.publish();
    for (const auto& sentence : certificate_words(scene, proved)) report.warn(sentence);
    report.done(result);
    if (proved.last() < scene.samples)
        throw method_failed("{}: nothing is proved after {:.6g} s of {:g} s; the rows end there", name,
                            scene.time(proved.last()), scene.time(scene.samples));
}

void certify_all(const CertifyOptions& options) {
    if (!(options.radius >= 1e-12 && options.radius <= 1e3))
        throw bad_input("--radius must be from 1e-12 to 1000 rad; it is {:g}", options.radius);
    const auto scenes = read_scenes(options, options.progress);
    const Destination to(options, scenes.size(), ".csv");
    if (options.list_outputs) {
        for (const auto& scene : scenes) list_outputs(options, scene.preset.name, certified_files(scene.preset.name));
        return;
    }
    work_on_all(scenes, options.progress, "samples", to.streamed,
                [&](const Scene& scene, ProgressReport& report) { certify(scene, options, to.folder, report); });
}

}  // namespace

void add_certify(CLI::App& app) {
    auto options = std::make_shared<CertifyOptions>();
    auto& command =
        *app.add_subcommand("certify", "Proves bounds of the true motion of two ideal links: CSV, manifest");
    command.footer(
        "At every sample the CSV has bounds of each angle and rate, and of the distance of the pair. All\n"
        "round-off, truncation and the decimals of the preset are included: docs/certified.md. Rows end\n"
        "where the proof ends, with exit code 3.\n"
        "Examples:\n"
        "  doppel certify butterfly\n"
        "  doppel certify butterfly --radius 0.01\n"
        "  doppel certify raindrop --set scene.duration_s=60 -o proofs");
    add_run_options(command, *options, "Threads; default: one a core; same bytes for any N");
    add_value(command, "--radius", options->radius, "RAD",
              "Finds how long the preset's own run stays this near the true motion, rad")
        ->capture_default_str();
    command.callback([options] { certify_all(*options); });
}

}  // namespace doppel

#include "film/run.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "film/film.hpp"
#include "film/manifest.hpp"
#include "film/rescue.hpp"
#include "film/simulation.hpp"
#include "film/table.hpp"
#include "output/part_files.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

void watch_worst(WorstErrors& worst, const Moment& moment) {
    worst.energy_a = std::max(worst.energy_a, std::abs(moment.energy_error_a.value_or(0)));
    worst.energy_b = std::max(worst.energy_b, std::abs(moment.energy_error_b.value_or(0)));
    worst.length_a = std::max(worst.length_a, moment.a.length_error);
    worst.length_b = std::max(worst.length_b, moment.b.length_error);
}

/// "NAME.failed.csv": what stays of a run that broke down.
std::string failed_name(const std::string& name, const std::string& ending) {
    return name + ".failed" + ending;
}

/// Keeps the samples before the break-down, under a name that says so, with a manifest; throws the error that tells
/// where they are, and which step would have held.
[[noreturn]] void keep_failed(const Scene& scene, const BreakDown& fault, RunRecord& record, PartFiles& parts,
                              const std::atomic<bool>& stop) {
    const auto& name = scene.preset.name;
    const auto advice = step_that_holds(scene, fault, stop);
    if (stop) throw Error(ExitCode::interrupted, "interrupted");
    record.failure = fmt::format("{}; {}", fault.what(), advice);
    record.last_sample = fault.sample - 1;
    const auto csv = failed_name(name, ".csv"), manifest = failed_name(name, ".json");
    parts.keep_only(name + ".csv", csv);
    parts.finished(csv);
    write_manifest(parts, manifest, scene, record);
    const auto files = parts.publish();
    throw method_failed("{}; the samples before are in {}", record.failure, files.front().string());
}

/// The samples that are asked for: first … last − 1; every `stride`th is reported, `total` in all.
struct SampleRange {
    long first, last, stride, total;
};

/// Throws Error (exit 2) where the scene has no such samples, none of them is a frame, or the poster is none of them.
SampleRange range_of(const Scene& scene, const RunOptions& options) {
    const long first = options.first, last = options.last < 0 ? scene.samples + 1 : options.last;
    if (first < 0 || first >= last || last > scene.samples + 1)
        throw bad_input("--frames {}:{}: {} has the samples 0 to {}; A:B must have 0 ≤ A < B ≤ {}", first, last,
                        scene.preset.name, scene.samples, scene.samples + 1);
    const long stride = options.pictures ? scene.samples_per_frame : 1;
    const long total = (last - 1) / stride - (first - 1 + stride) / stride + 1;
    if (options.pictures && total < 1)
        throw bad_input("--frames {}:{}: no frame of {} falls into it; every {}th sample is one", first, last,
                        scene.preset.name, stride);
    if (const auto poster = poster_sample(scene); options.pictures && poster && (*poster < first || *poster >= last))
        throw bad_input("--frames {}:{}: the poster of {}, poster_s = {}, is sample {}; --frames {}:{} would have it",
                        first, last, scene.preset.name, scene.preset.video.poster_s->text(), *poster,
                        std::min(first, *poster), std::max(last, *poster + 1));
    return {first, last, stride, total};
}

}  // namespace

void check_range(const Scene& scene, const RunOptions& options) {
    range_of(scene, options);
}

RunResult run(const Scene& scene, const RunOptions& options, const std::atomic<bool>& stop,
              const std::function<void(const Progress&)>& report) {
    const double wall_start = seconds_of(CLOCK_MONOTONIC), cpu_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const auto [first, last, stride, total] = range_of(scene, options);
    RunRecord record{.first_sample = first, .last_sample = last - 1};
    PartFiles parts(options.out / scene.preset.name);
    std::optional<Film> film;
    auto range = options;
    range.first = first, range.last = last;
    if (options.pictures) film.emplace(scene, range, parts, record, stop);
    const auto csv_name = scene.preset.name + ".csv";
    PairTable table(parts.file(csv_name), scene);

    Simulation simulation(scene, last, options.pictures, stop);
    const auto take_efforts = [&] { std::tie(record.effort_a, record.effort_b) = simulation.efforts(); };
    double start_distance = 0;
    for (long sample = 0, done = 0; sample < last; ++sample) {
        Shot shot;
        try {
            shot = simulation.next();
        } catch (const BreakDown& fault) {
            take_efforts();
            table.finish();
            film.reset();  // its threads write into what goes now
            keep_failed(scene, fault, record, parts, stop);
        }
        const auto& moment = shot.moment;
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        check_distance(scene, moment);
        if (sample == 0) start_distance = moment.distance;
        watch_worst(record.worst, moment);
        record.largest_distance = std::max(record.largest_distance, moment.distance);
        if (film) film->add(shot);
        if (sample < first) continue;
        table.add(moment, start_distance);
        if (sample % stride != 0) continue;
        if (film) film->shoot(record);
        report({++done, total});
    }
    take_efforts();
    const auto finish = [&] {
        if (film) film->finish();
        table.finish();
        parts.finished(csv_name);
        record.simulate_cpu_s = simulation.cpu_s();
        record.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start;
        record.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start;
        record.encode_cpu_s =
            std::max(0.0, record.cpu_s - record.simulate_cpu_s - record.draw_cpu_s - record.write_cpu_s);
        // a failed run's files from before are no news beside a whole one
        for (const char* ending : {".csv", ".json"}) parts.remove(failed_name(scene.preset.name, ending));
        write_manifest(parts, scene.preset.name + ".json", scene, record);
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        return parts.publish();
    };
    auto files = parts.keeping_finished(finish);
    return {.files = std::move(files), .frames = record.frames, .samples = last - first, .wall_s = record.wall_s};
}

}  // namespace doppel

#include "film/run.hpp"

#include "analysis/difference.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "film/film.hpp"
#include "film/pair_table.hpp"
#include "output/transaction.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

/// Keeps the largest errors.
void watch(SideRecord& record, const Observation& seen, std::optional<double> energy_error) {
    record.energy_error = std::max(record.energy_error, std::abs(energy_error.value_or(0)));
    if (energy_error) record.energy_change = std::max(record.energy_change, std::abs(seen.energy_change));
    record.length_error = std::max(record.length_error, seen.length_error);
}

/// Whether the side comes to `sample`; `effort` ← what it took.
bool holds(const Scene& scene, const Side& side, const BreakDown& fault, const std::atomic<bool>& stop,
           Effort& effort) {
    SideRun run(scene, side, fault.side);
    try {
        for (long sample = 0; sample <= fault.sample; ++sample) {
            run.next(stop);
            effort = run.effort();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed && error.code() != ExitCode::interrupted) throw;
        return false;
    }
    return true;
}

/// What would have held where `fault` broke down, in words: with a fixed step, the first of its halves, quarters … that
/// comes as far; of an adaptive method, the smallest step that it took. Gives up early where `stop` is set.
std::string step_that_holds(const Scene& scene, const BreakDown& fault, const std::atomic<bool>& stop) {
    auto side = fault.side == 'a' ? scene.a : scene.b;
    Effort effort;
    if (side.method.adaptive) {
        holds(scene, side, fault, stop, effort);
        if (effort.smallest_step == 0) return "not even a first step held";
        return fmt::format("the smallest step that held was {:.3g} s; a smaller tolerance may hold",
                           effort.smallest_step);
    }
    auto finest = side.step;                 // that was tried
    constexpr long most_steps = 20'000'000;  // a few seconds for a double pendulum
    for (int halvings = 1; halvings < 40 && !stop; ++halvings) {
        const auto half = quotient(side.step, {2, 1});
        if (!half) break;
        side.step = *half;
        side.motion.steps_per_sample *= 2;
        const auto bobs = static_cast<long>(side.mass.size());
        if (side.motion.steps_per_sample > most_steps / (bobs * std::max(1L, fault.sample))) break;
        if (holds(scene, side, fault, stop, effort))
            return fmt::format("halved until it held: step_s = \"{}\" comes further", side.step.text());
        finest = side.step;
    }
    return fmt::format("no step down to {} s held", finest.text());
}

/// "NAME.failed.csv": what stays of a run that broke down.
std::string failed_name(const std::string& name, const std::string& ending) {
    return name + ".failed" + ending;
}

/// Keeps the samples before the break-down, under a name that says so, with a manifest; throws the error that tells
/// where they are, and which step would have held.
[[noreturn]] void keep_failed(const Scene& scene, const BreakDown& fault, RunRecord& record, Transaction& parts,
                              const std::atomic<bool>& stop) {
    const auto& name = scene.preset.name;
    const auto advice = step_that_holds(scene, fault, stop);
    throw_if_set(stop);
    record.failure = fmt::format("{}; {}", fault.what(), advice);
    record.last_sample = fault.sample - 1;
    add_warnings(scene, record, stop);
    const auto csv = failed_name(name, ".csv"), manifest = failed_name(name, ".json");
    parts.keep_only(name + ".csv", csv);
    parts.finished(csv);
    write_manifest(parts, manifest, scene, record);
    const auto files = parts.publish();
    throw method_failed("{}; the samples before are in {}", record.failure, files.front().string());
}

/// The samples that are asked for: first … last − 1; `total` is reported of them, the frames where there are pictures.
struct SampleRange {
    long first, last, total;
};

/// The samples from `from_s` to `to_s`. Throws Error (exit 2) where there is none.
std::pair<long, long> samples_between(const Scene& scene, const RunOptions& options) {
    const auto &name = scene.preset.name, duration = scene.preset.duration_s.text();
    const double hz = scene.preset.sample_hz.value(), end = scene.preset.duration_s.value();
    const double from = options.from_s ? options.from_s->value() : 0, to = options.to_s ? options.to_s->value() : end;
    for (const auto& [option, time] : {std::pair("--from", from), {"--to", to}})
        if (time > end) throw bad_input("{} {}: {} ends at {} s", option, time, name, duration);
    if (from > to) throw bad_input("--from {} --to {}: the end must not be before the start", from, to);
    constexpr double slack = 1e-9;  // samples, of rounding
    const long first = std::lround(std::ceil(from * hz - slack)), last = std::lround(std::floor(to * hz + slack));
    if (first > last)
        throw bad_input("--from {} --to {}: {} has no sample there; they are {:.3g} s apart", from, to, name, 1 / hz);
    return {first, last + 1};
}

/// Throws Error (exit 2) where the scene has no such samples, none of them is a frame, or the poster is none of them.
SampleRange range_of(const Scene& scene, RunOptions options) {
    if (options.from_s || options.to_s) std::tie(options.first, options.last) = samples_between(scene, options);
    const long first = options.first, last = options.last < 0 ? scene.samples + 1 : options.last;
    if (first < 0 || first >= last || last > scene.samples + 1)
        throw bad_input("--frames {}:{}: {} has the samples 0 to {}; A:B must have 0 ≤ A < B ≤ {}", first, last,
                        scene.preset.name, scene.samples, scene.samples + 1);
    if (!options.pictures) return {first, last, last - first};
    const auto& frames = scene.frames;
    const long begin = first * frames.ticks_per_sample, end = (last - 1) * frames.ticks_per_sample;
    const long total = frames.first_from(end + 1) - frames.first_from(begin);
    if (total < 1)
        throw bad_input("--frames {}:{}: no frame of {} falls into it; every {}th sample is one", first, last,
                        scene.preset.name, frames.stride);
    if (const auto poster = poster_tick(scene); poster && (*poster < begin || *poster > end)) {
        const long sample = *poster / frames.ticks_per_sample, after = (*poster - 1) / frames.ticks_per_sample + 1;
        throw bad_input("--frames {}:{}: the poster of {}, poster_s = {}, is sample {}; --frames {}:{} would have it",
                        first, last, scene.preset.name, scene.preset.video.poster_s->text(), sample,
                        std::min(first, sample), std::max(last, after + 1));
    }
    return {first, last, total};
}

}  // namespace

void check_run(const Scene& scene, const RunOptions& options) {
    range_of(scene, options);
    columns_of(scene, options.columns);
}

std::vector<std::string> run_files(const Scene& scene, bool pictures) {
    const auto& [name, video] = std::pair(scene.preset.name, scene.preset.video);
    std::vector<std::string> files;
    if (pictures)
        files.push_back(video.format == FilmFormat::png ? "frames/"
                                                        : fmt::format("{}.{}", name, name_of(video.format)));
    files.push_back(name + ".csv");
    if (pictures && video.poster_s) files.push_back(name + ".poster.png");
    if (pictures && video.contact_sheet) files.push_back(name + ".contact.png");
    files.push_back(name + ".json");
    return files;
}

RunResult run(const Scene& scene, const RunOptions& options, const std::atomic<bool>& stop,
              const std::function<void(const Progress&)>& report) {
    const double wall_start = seconds_of(CLOCK_MONOTONIC), cpu_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    const auto [first, last, total] = range_of(scene, options);
    RunRecord record{.first_sample = first, .last_sample = last - 1};
    Transaction parts(options.out / scene.preset.name, "run", "film", options.replacing);
    parts.demand(scene.preset.name + ".json");
    std::optional<Film> film;
    auto range = options;
    range.first = first, range.last = last;
    if (options.pictures) film.emplace(scene, range, parts, record, stop);
    const auto csv_name = scene.preset.name + ".csv";
    PairTable table(parts.file(csv_name), scene, options.columns);

    Simulation simulation(scene, last, options.pictures, stop);
    const auto take_efforts = [&] { std::tie(record.a.effort, record.b.effort) = simulation.efforts(); };
    double start_distance = 0;
    const auto& frames = scene.frames;
    const long begin = first * frames.ticks_per_sample, end = (last - 1) * frames.ticks_per_sample;
    for (long tick = -1, done = 0; tick < end;) {
        Snapshot snapshot;
        try {
            snapshot = simulation.next();
        } catch (const BreakDown& fault) {
            take_efforts();
            table.finish();
            film.reset();  // its threads write into what goes now
            keep_failed(scene, fault, record, parts, stop);
        }
        const auto& state = snapshot.pair;
        throw_if_set(stop);
        check_distance(scene, state);
        tick = state.tick;
        if (tick == 0) start_distance = state.distance;
        watch(record.a, state.a, state.energy_error_a);
        watch(record.b, state.b, state.energy_error_b);
        record.largest_distance = std::max(record.largest_distance, state.distance);
        record.parting.add(scene.time_of_tick(tick), state.distance);
        if (film) film->add(snapshot);
        if (tick < begin) continue;
        if (tick % frames.ticks_per_sample == 0) table.add(state, start_distance);
        const long frame = frames.first_from(tick);
        if (film && (frame == frames.count() || frames.tick(frame) != tick)) continue;
        if (film) film->write_frame(record);
        report({++done, total});
    }
    take_efforts();
    const auto finish = [&] {
        if (film) film->finish();
        table.finish();
        parts.finished(csv_name);
        record.simulate_cpu_s = simulation.cpu_s();
        record.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start;
        add_warnings(scene, record, stop);
        record.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start;
        record.encode_cpu_s =
            std::max(0.0, record.cpu_s - record.simulate_cpu_s - record.draw_cpu_s - record.write_cpu_s);
        // a failed run's files from before are no news beside a whole one
        for (const char* ending : {".csv", ".json"}) parts.remove(failed_name(scene.preset.name, ending));
        write_manifest(parts, scene.preset.name + ".json", scene, record);
        throw_if_set(stop);
        return parts.publish();
    };
    auto files = parts.keeping_finished(finish);
    return {.files = std::move(files),
            .frames = record.frames,
            .samples = last - first,
            .wall_s = record.wall_s,
            .warnings = record.warnings};
}

}  // namespace doppel

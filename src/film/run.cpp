#include "film/run.hpp"

#include "base/error.hpp"
#include "base/machine.hpp"
#include "film/film.hpp"
#include "film/page.hpp"
#include "film/pair_table.hpp"

#include <algorithm>
#include <utility>

namespace doppel {
namespace {

/// Whether the side reaches the sample at which `failure` occurred.
bool is_sufficient(const Scene& scene, const Side& side, const RunFailure& failure, const std::atomic<bool>& stop) {
    SideRun run(scene, side, failure.side);
    try {
        for (long sample = 0; sample <= failure.sample; ++sample) run.next(stop);
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed && error.code() != ExitCode::interrupted) throw;
        return false;
    }
    return true;
}

/// In words: of a fixed step, the first half, quarter … that reaches the sample of `failure`; of an adaptive method,
/// its smallest step before.
std::string sufficient_step(const Scene& scene, const RunFailure& failure, const MotionRecord& before,
                            const std::atomic<bool>& stop) {
    auto side = failure.side == 'a' ? scene.a : scene.b;
    if (side.method.adaptive) {
        const double smallest = (failure.side == 'a' ? before.a : before.b).effort.smallest_step;
        if (smallest == 0) return "the first step failed";
        return fmt::format("the smallest step before was {:.3g} s; a smaller tolerance may work", smallest);
    }
    auto finest = side.step;                // tried
    constexpr long max_steps = 20'000'000;  // a few seconds for a double pendulum
    const long samples = static_cast<long>(side.mass.size()) * std::max(1L, failure.sample);
    for (int halvings = 1; halvings < 40 && !stop; ++halvings) {
        const auto half = quotient(side.step, {2, 1});
        side.motion.steps_per_sample *= 2;
        if (!half || side.motion.steps_per_sample > max_steps / samples) break;
        side.step = *half;
        if (is_sufficient(scene, side, failure, stop))
            return fmt::format("step_s = \"{}\" gets further", side.step.text());
        finest = side.step;
    }
    return fmt::format("no step down to {} s works", finest.text());
}

std::string failed_name(const std::string& name, const std::string& ending) {
    return name + ".failed" + ending;
}

/// Keeps the samples before the failure, unless the folder is temporary. Throws the error with their path and advice.
[[noreturn]] void keep_failed(const Scene& scene, const RunFailure& failure, RunRecord& record, Transaction& parts,
                              const std::atomic<bool>& stop) {
    const auto& name = scene.preset.name;
    const auto advice = sufficient_step(scene, failure, record.motion, stop);
    throw_if_set(stop);
    record.failure = fmt::format("{}; {}", failure.what(), advice);
    if (parts.is_temporary()) throw method_failed("{}", record.failure);
    record.last_sample = failure.sample - 1;
    add_warnings(scene, record, stop);
    const auto csv = failed_name(name, ".csv");
    parts.keep_only(name + ".csv", csv);
    write_manifest(parts, failed_name(name, ".json"), scene, record);
    const auto files = parts.publish();
    throw method_failed("{}; the samples before are in {}", record.failure, files.front().string());
}

/// The frames first … last − 1 to draw, and the samples of the same period: from `begin` to before `end`.
struct Part {
    long first, last;
    Moment begin, end;

    long first_sample() const { return begin.share > 0 ? begin.sample + 1 : begin.sample; }
    long last_sample() const { return end.share > 0 ? end.sample : end.sample - 1; }
};

Part part_between(const Scene& scene, const RunOptions& options) {
    const auto& name = scene.preset.name;
    const double duration = scene.preset.duration_s.value(), hz = scene.preset.sample_hz.value();
    const double from = options.from_s ? options.from_s->value() : 0;
    const double to = options.to_s ? options.to_s->value() : duration;
    for (const auto& [option, time] : {std::pair("--from", from), {"--to", to}})
        if (time > duration) throw bad_input("{} {}: {} ends at {:.6g} s", option, time, name, duration);
    if (options.to_s && from >= to)
        throw bad_input("--from {} --to {}: the end, which is not included, must be after the start", from, to);
    const auto begin = moment_at(from * hz), end = options.to_s ? moment_at(to * hz) : Moment{scene.samples + 1};
    const Part part{scene.frames.first_from(begin), scene.frames.first_from(end), begin, end};
    if (part.first >= part.last)
        throw bad_input("--from {} --to {}: {} has no frame in this interval; frames are {:.3g} s apart", from, to,
                        name, scene.preset.video.speed.slowest().value() / scene.fps.value());
    return part;
}

Part part_of_frames(const Scene& scene, const RunOptions& options) {
    const auto& frames = scene.frames;
    const long first = options.first, last = options.last < 0 ? frames.count : options.last;
    if (first < 0 || first >= last || last > frames.count)
        throw bad_input("--frames {}:{}: {} has the frames 0 to {}; A:B must have 0 ≤ A < B ≤ {}", first, last,
                        scene.preset.name, frames.count - 1, frames.count);
    return {first, last, frames.at(first), last == frames.count ? Moment{scene.samples + 1} : frames.at(last)};
}

/// Of a part of the film, all frames up to its last one. Throws Error (exit 2) if the poster's frame is not included.
Part part_of(const Scene& scene, const RunOptions& options) {
    if (options.is_part()) {
        const auto schedule = schedule_of(scene);
        const long last = drawn_frames(scene, options, 0).last - schedule.before();
        return part_of_frames(scene, {.last = std::clamp(last, 1L, schedule.motion)});
    }
    const bool by_time = options.from_s || options.to_s;
    const auto part = by_time ? part_between(scene, options) : part_of_frames(scene, options);
    const bool is_page = options.pictures && scene.preset.video.format == FilmFormat::html;
    if (is_page && part.begin > Moment{})
        throw bad_input("a page shows {} from the start: --from and --frames must begin at 0", scene.preset.name);
    const auto poster = options.pictures && !is_page ? poster_frame(scene) : std::nullopt;
    if (poster && (*poster < part.first || *poster >= part.last))
        throw bad_input("--frames {}:{}: the poster of {}, poster_s = {}, is frame {}; --frames {}:{} includes it",
                        part.first, part.last, scene.preset.name, scene.preset.video.poster_s->value(), *poster,
                        std::min(part.first, *poster), std::max(part.last, *poster + 1));
    return part;
}

}  // namespace

void check_run(const Scene& scene, const RunOptions& options) {
    if ((options.shard || options.merge) && options.is_partial())
        throw bad_input("--shard and --merge are for the whole film; --frames, --from and --to for another part");
    if (options.shard || options.merge) frames_of(scene, options.shard.value_or(Shard{}));
    part_of(scene, options);
    columns_of(scene, options.columns);
}

std::vector<std::string> run_files(const Scene& scene, const RunOptions& options) {
    const auto& [name, video] = std::pair(scene.preset.name, scene.preset.video);
    bool pictures = options.pictures;
    if (options.shard) return {part_name(scene, *options.shard)};
    std::vector<std::string> files;
    if (pictures) files.push_back(video.format == FilmFormat::png ? "frames/" : name + extension(video.format));
    files.push_back(name + ".csv");
    if (video.format == FilmFormat::html) pictures = false;
    if (pictures && video.poster_s) files.push_back(name + ".poster.png");
    if (pictures && video.contact_sheet) files.push_back(name + ".contact.png");
    files.push_back(name + ".json");
    return files;
}

RunResult run(const Scene& scene, const RunOptions& options, const std::atomic<bool>& stop, const Report& report) {
    const double wall_start = seconds_of(CLOCK_MONOTONIC) - scene.made_wall_s,
                 cpu_start = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - scene.made_cpu_s;
    const auto& name = scene.preset.name;
    const auto& shard = options.shard;
    const auto part = part_of(scene, options);
    const bool is_page = options.pictures && scene.preset.video.format == FilmFormat::html;
    const bool is_film = options.pictures && !is_page, is_recorded = !options.record_to.empty();
    Transaction parts(options.out / name, shard ? fmt::format("shard-{}-of-{}", shard->number, shard->of) : "run",
                      "film", options.replacing);
    if (shard && is_part_complete(scene, *shard, parts.folder()))
        return {.files = {parts.folder() / part_name(scene, *shard)}};
    for (const auto& file : run_files(scene, options)) parts.require(file);  // before the simulation
    if (options.merge) parts_in(scene, parts.folder());  // so that errors are reported before the simulation
    RunRecord record;
    Recording recording(scene, part.end, options.pictures || is_recorded, stop, options.recording);
    std::optional<BlockFile> recorder;
    if (is_recorded) recorder.emplace(options.record_to, recording_header(scene));
    std::optional<Film> film;
    std::optional<FilmPage> page;
    if (is_film && !recording.fails())
        film.emplace(scene, recording.bounds(), options, part.first, part.last, parts, record, stop);
    if (is_page && !recording.fails()) page.emplace(scene, recording.bounds(), parts);
    const auto csv_name = name + ".csv";
    std::optional<Csv> table;
    if (!options.is_part()) {
        record.first_sample = part.first_sample();
        record.last_sample = part.last_sample();
        record.samples = record.last_sample - record.first_sample + 1;
        table.emplace(parts.file(csv_name), columns_of(scene), columns_of(scene, options.columns));
    }
    long done = 0;
    const long total = !table    ? drawn_frames(scene, options, 0).count()
                       : is_film ? part.last - part.first
                                 : record.samples;
    const auto add = [&](const Snapshot& snapshot) {
        const auto& state = snapshot.pair;
        throw_if_set(stop);
        if (recorder) add_snapshot(*recorder, snapshot, recording.record().a.effort, recording.record().b.effort);
        if (page) page->add(snapshot);
        if (table && state.share == 0 && state.sample >= record.first_sample) {
            add_row(*table, scene, snapshot, recording.record().outcome.start_distance);
            if (!is_film) report({++done, total});
        }
        if (film && film->add(snapshot)) report({table ? ++done : record.frames, total});
    };
    try {
        recording.play(add);
    } catch (const RunFailure& failure) {
        if (!table) throw;
        record.motion = recording.record();
        table->finish();
        film.reset();  // its threads use what is destroyed next
        keep_failed(scene, failure, record, parts, stop);
    }
    const auto finish = [&] {
        record.motion = recording.record();
        record.events = film_events(scene, record.motion.outcome);
        if (recorder) recorder->finish();
        if (film) film->finish(record.events);
        if (page) page->finish(record.motion.outcome);
        if (film && table && scene.preset.video.contact_sheet)
            film->write(".contact.png", contact_sheet_of(scene, recording, part.first, part.last, options.gl, stop));
        record.wall_s = seconds_of(CLOCK_MONOTONIC) - wall_start;
        if (table) {
            table->finish();
            parts.finished(csv_name);
            record.simulate_cpu_s = recording.cpu_s();
            if (options.checks_accuracy) add_warnings(scene, record, stop);
            record.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_start;
            record.encode_cpu_s = std::max(
                0.0, record.cpu_s - scene.made_cpu_s - record.simulate_cpu_s - record.draw_cpu_s - record.write_cpu_s);
            // files of an earlier run that failed
            for (const char* ending : {".csv", ".json"}) parts.remove(failed_name(name, ending));
            write_manifest(parts, name + ".json", scene, record);
        }
        throw_if_set(stop);
        return parts.publish();
    };
    record.files = parts.keeping_finished(finish);
    return std::move(static_cast<RunResult&>(record));
}

}  // namespace doppel

#include "film/estimate.hpp"

#include "base/error.hpp"
#include "base/threads.hpp"
#include "film/film.hpp"
#include "integrate/motion_batch.hpp"
#include "output/files.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <future>
#include <limits>
#include <utility>

namespace doppel {
namespace {

/// How far a probe has come.
struct ProbePoint {
    double cpu_s = 0, done = 0, steps = 0;
};

SimulationEstimate estimated_side(const Scene& scene, Side side, char name, const std::atomic<bool>& stop) {
    // methods with their own steps are probed longer: a whip takes most of them after its crack
    const bool adaptive = side.method.adaptive;
    const double probe_s = adaptive ? 1 : 0.025;
    constexpr double patience_s = 0.3, longest_s = 4;  // of the first sample; of all, if other programs run
    constexpr double recent = 2.0 / 3;  // from this share of the probe on, its steps are like those of the rest
    const auto samples = static_cast<double>(scene.samples),
               steps_in_all = samples * static_cast<double>(side.motion.steps_per_sample);
    // one sample may take many steps: parts of it are timed
    constexpr double shortened_s = 0.01, few_steps = 250, max_parts = 1e12;
    const double wanted_parts =
        adaptive ? side.motion.sample_interval.value() / shortened_s : steps_in_all / samples / few_steps;
    long parts = std::lround(std::clamp(std::ceil(wanted_parts), 1.0, max_parts));
    if (const auto shortened = quotient(side.motion.sample_interval, {parts, 1}))
        side.motion.sample_interval = *shortened;
    else
        parts = 1;
    side.motion.steps_per_sample = std::max(1L, side.motion.steps_per_sample / parts);
    const double all = samples * static_cast<double>(parts);
    SideRun run(scene, side, name);
    const TimeLimit first_limit(patience_s, stop), limit(longest_s, stop);
    ProbePoint from, last;  // from: where the recent part of the probe begins
    double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto add_point = [&] {
        if (last.cpu_s <= recent * probe_s) from = last;
        const long least = adaptive ? 1 : side.motion.steps_per_sample;
        last = {seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, last.done + 1,
                static_cast<double>(std::max(run.effort().steps, least))};
    };
    bool at_least = false;
    try {
        run.next(first_limit.reached());
        start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        while (last.done < all && last.cpu_s < probe_s) {
            run.next((last.done == 0 ? first_limit : limit).reached());
            add_point();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::interrupted || stop) throw;
        at_least = last.done == 0;
        if (at_least) add_point();
    }
    const double rate = (last.steps - from.steps) / (last.done - from.done),
                 steps = adaptive ? last.steps + (all - last.done) * rate : steps_in_all;
    return {last.cpu_s * steps / last.steps, steps, at_least};
}

/// Time for the motion of an ensemble's members, s per sample.
double seconds_of_members(const Scene& scene, const std::atomic<bool>& stop) {
    if (scene.members.empty()) return 0;
    constexpr double probe_s = 0.05;
    MotionBatch members(scene.members, 1);
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    double elapsed = 0, samples = 0;
    for (; elapsed < probe_s; ++samples) {
        members.advance(stop);
        elapsed = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
    }
    return elapsed / samples;
}

/// The film up to that sample, without cards, poster and contact sheet.
Scene beginning_of(Scene scene, long samples) {
    auto& frames = scene.frames;
    scene.samples = samples;
    frames.count = frames.first_from({samples}) + 1;
    frames.last = {samples};
    if (!frames.changing.empty()) frames.changing.resize(static_cast<std::size_t>(frames.count - 1));
    auto& preset = scene.preset;
    preset.duration_s = quotient({scene.samples, 1}, preset.sample_hz).value_or(preset.duration_s);
    auto& video = preset.video;
    video.poster_s.reset();
    video.contact_sheet.reset();
    video.hold_start_s = video.hold_end_s = video.title_card_s = video.end_card_s = {0, 1};
    return scene;
}

/// What a run takes.
struct Trial {
    double frames, rows;        // of the film; of the table
    double wall_s, cpu_s;       // from the first frame or row on
    double run_s;               // of the whole run
    double bytes, table_bytes;  // of the film; of the table, with its header
};

double bytes_of(const std::filesystem::path& film) {
    if (!std::filesystem::is_directory(film)) return static_cast<double>(std::filesystem::file_size(film));
    double bytes = 0;
    for (const auto& picture : std::filesystem::directory_iterator(film)) bytes += bytes_of(picture.path());
    return bytes;
}

/// Of the last `count` frames of the scene.
Trial trial_of(const Scene& scene, long count, const std::atomic<bool>& stop) {
    const TemporaryFolder folder;
    double wall_s = 0, cpu_s = 0;
    const RunOptions options{
        .out = folder.path(), .first = std::max(scene.frames.count - count, 0L), .checks_accuracy = false};
    const auto result = run(scene, options, stop, [&](const Progress& progress) {
        if (progress.done == 1) wall_s = seconds_of(CLOCK_MONOTONIC), cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    });
    return {.frames = static_cast<double>(result.frames),
            .rows = static_cast<double>(result.samples),
            .wall_s = seconds_of(CLOCK_MONOTONIC) - wall_s,
            .cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_s,
            .run_s = result.wall_s,
            .bytes = bytes_of(result.files.front()),
            .table_bytes = bytes_of(folder.path() / scene.preset.name / (scene.preset.name + ".csv"))};
}

/// Of few frames, and of many, if that takes little time; of a page, of few samples and of all.
std::pair<Trial, Trial> trials_of(const Scene& scene, const std::atomic<bool>& stop) {
    if (scene.preset.video.format == FilmFormat::html) {
        const auto few = beginning_of(scene, std::min(scene.samples, 2L));
        return {trial_of(few, few.frames.count, stop), trial_of(scene, scene.frames.count, stop)};
    }
    constexpr double sufficient_s = 0.1, slow_s = 2;
    const auto few = trial_of(scene, 2, stop);
    auto many = few;
    for (long count = 8; count <= 128 && few.cpu_s < slow_s && many.wall_s - few.wall_s < sufficient_s; count *= 4)
        many = trial_of(scene, count, stop);
    return {few, many};
}

/// Memory of x264's own presets for the frames that they look ahead, bytes: the trial is too short to fill it.
double lookahead_bytes(const VideoSpec& video) {
    constexpr double frames = 27, yuv_bytes = 1.5;  // frames for each step from ultrafast on; measured
    const auto preset = std::ranges::find(encoder_presets, video.preset) - encoder_presets.begin();
    if (video.format != FilmFormat::mp4) return 0;
    return frames * static_cast<double>(std::max(preset - 1, std::ptrdiff_t{0})) * yuv_bytes * video.size.width *
           video.size.height;
}

}  // namespace

SimulationEstimate estimated_simulation(const Scene& scene, const std::atomic<bool>& stop) {
    const auto probe = [&](char letter) {
        const auto& side = scene.side(letter);
        return side.replay ? SimulationEstimate{} : estimated_side(scene, side, letter, stop);
    };
    auto other = std::async([&] { return scene.is_single() ? SimulationEstimate{} : probe('b'); });
    const auto a = probe('a'), b = other.get();  // an error of side a comes first
    return {a.seconds + b.seconds, a.steps + b.steps, a.at_least || b.at_least};
}

Needs estimated_render(const Scene& scene, const SimulationEstimate& simulation, const std::atomic<bool>& stop) {
    // measured after the first half of the motion, where trails are long and ensembles have diverged, on a whole page, or
    // on as much as is simulated in `begin_s`
    const auto& video = scene.preset.video;
    const bool is_page = video.format == FilmFormat::html;
    const double begin_s = is_page ? 4 : 0.6, patience_s = 1;  // a page draws nothing in the meantime
    const auto samples = static_cast<double>(scene.samples);
    const double motions_s = simulation.seconds + seconds_of_members(scene, stop) * samples;
    const double sample_s = motions_s / samples;
    Needs estimate{.seconds = motions_s,
                   .cpu_s = motions_s,
                   .repeated_cpu_s = motions_s,
                   .disk_bytes = std::numeric_limits<double>::quiet_NaN(),  // unknown
                   .at_least = simulation.at_least};
    const auto second = scene.frames.at(std::min(1L, scene.frames.count - 1));
    const long one_frame = std::max(1L, second.sample + (second.share > 0 ? 1 : 0));
    if (!simulation.at_least && sample_s * static_cast<double>(one_frame) <= patience_s) {
        const double wanted = std::min(is_page ? samples : samples / 2, begin_s / std::max(sample_s, 1e-12));
        const auto begun = beginning_of(
            scene, std::clamp(static_cast<long>(wanted), std::min(one_frame, scene.samples), scene.samples));
        const auto [few, many] = trials_of(begun, stop);
        // the cost of one frame, or of one sample of a page; what the first of them have more, each segment has
        const auto each = [&few = few, &many = many](double Trial::*number, double Trial::*part) {
            const double more = many.*number - few.*number;
            return more > 0 ? std::max(many.*part - few.*part, 0.0) / more : few.*part / std::max(few.*number, 1.0);
        };
        const auto number = is_page ? &Trial::rows : &Trial::frames;
        const double count = is_page ? samples + 1 : static_cast<double>(schedule_of(scene).frames()),
                     bytes = each(number, &Trial::bytes),
                     wall_s = count * (is_page ? std::max(each(number, &Trial::run_s) - sample_s, 0.0)
                                               : each(number, &Trial::wall_s)),
                     cpu_s = is_page ? wall_s : count * each(number, &Trial::cpu_s);
        if (video.format_row().has_parts()) estimate.most_shards = max_shards(scene);
        estimate.seconds += few.run_s + std::max(wall_s, cpu_s / cores());
        estimate.cpu_s += few.run_s + cpu_s;
        estimate.film_bytes = bytes * count + std::max(few.bytes - few.*number * bytes, 0.0) *
                                                  static_cast<double>(std::max(estimate.most_shards, 1L));
        estimate.disk_bytes = each(&Trial::rows, &Trial::table_bytes) * (samples + 1) + estimate.film_bytes;
    }
    const bool keeps_motion = depends_on_motion(scene) || video.contact_sheet;
    const double motion_bytes = recorded_bytes(scene, {scene.samples + 1});
    estimate.memory_bytes = peak_memory() + lookahead_bytes(video) +
                            (keeps_motion && motion_bytes <= Recording::usual_bytes ? motion_bytes : 0);
    return estimate;
}

}  // namespace doppel

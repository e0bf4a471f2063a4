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

namespace doppel {
namespace {

/// How far a probe has come.
struct ProbePoint {
    double cpu_s = 0;
    long done = 0, steps = 0;
};

SimulationEstimate estimated_side(const Scene& scene, Side side, char name, const std::atomic<bool>& stop) {
    // methods with their own steps are probed longer: a whip takes most of them after its crack
    const bool adaptive = side.method.adaptive;
    const double probe_s = adaptive ? 1 : 0.025;
    constexpr double patience_s = 0.3, longest_s = 4;  // of the first sample; of all, if other programs run
    constexpr double recent = 2.0 / 3;  // from this share of the probe on, its steps are like those of the rest
    // one sample may take many steps: parts of it are timed
    constexpr long few_steps = 250;
    constexpr double shortened_s = 0.01, max_parts = 1e12;
    auto& interval = side.motion.sample_interval;
    const long steps_per_sample = side.motion.steps_per_sample;
    long parts = adaptive ? std::llround(std::clamp(std::ceil(interval.value() / shortened_s), 1.0, max_parts))
                          : std::max(1L, steps_per_sample / few_steps);
    if (const auto shortened = quotient(interval, {parts, 1}))
        interval = *shortened, side.motion.steps_per_sample = std::max(1L, steps_per_sample / parts);
    else
        parts = 1;
    const double all = static_cast<double>(scene.samples) * static_cast<double>(parts);
    SideRun run(scene, side, name);
    const TimeLimit first_limit(patience_s, stop), limit(longest_s, stop);
    ProbePoint from, last;  // from: where the recent part of the probe begins
    double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    const auto add_point = [&] {
        if (last.cpu_s <= recent * probe_s) from = last;
        last = {seconds_of(CLOCK_THREAD_CPUTIME_ID) - start, last.done + 1, std::max(run.effort().steps, 1L)};
    };
    bool at_least = false;
    try {
        run.next(first_limit.reached());
        start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
        while (static_cast<double>(last.done) < all && last.cpu_s < probe_s) {
            run.next((last.done == 0 ? first_limit : limit).reached());
            add_point();
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::interrupted || stop) throw;
        at_least = last.done == 0;
        if (at_least) add_point();
    }
    const double rest = all - static_cast<double>(last.done),
                 rate = static_cast<double>(last.steps - from.steps) / static_cast<double>(last.done - from.done),
                 probed = static_cast<double>(last.steps);
    if (!adaptive)
        return {last.cpu_s * all / static_cast<double>(last.done),
                static_cast<double>(scene.samples) * static_cast<double>(steps_per_sample), at_least};
    const double steps = probed + rest * rate;
    return {last.cpu_s * steps / probed, steps, at_least};
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

struct FrameCost {
    double frames = 1, wall_s = 0, cpu_s = 0;  // from the first of them on
    double bytes = 0;                          // of the film
    double rows = 0, table_bytes = 0;          // of the table, with its header
    double run_s = 0, key_bytes = 0;           // of the whole run; what a key frame has more than others
};

double bytes_of(const std::filesystem::path& film) {
    if (!std::filesystem::is_directory(film)) return static_cast<double>(std::filesystem::file_size(film));
    double bytes = 0;
    for (const auto& picture : std::filesystem::directory_iterator(film)) bytes += bytes_of(picture.path());
    return bytes;
}

/// Measured on the last `count` frames of the scene.
FrameCost cost_of_frames(const Scene& scene, long count, const std::atomic<bool>& stop) {
    const TemporaryFolder folder;
    double wall_s = 0, cpu_s = 0;
    const RunOptions options{
        .out = folder.path(), .first = std::max(scene.frames.count - count, 0L), .checks_accuracy = false};
    const auto result = run(scene, options, stop, [&](const Progress& progress) {
        if (progress.done == 1) wall_s = seconds_of(CLOCK_MONOTONIC), cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    });
    return {.frames = static_cast<double>(result.frames),
            .wall_s = seconds_of(CLOCK_MONOTONIC) - wall_s,
            .cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu_s,
            .bytes = bytes_of(result.files.front()),
            .rows = static_cast<double>(result.samples),
            .table_bytes = bytes_of(folder.path() / scene.preset.name / (scene.preset.name + ".csv")),
            .run_s = result.wall_s};
}

/// The cost of one frame, and of one row: the difference between many frames and few. `run_s` is that of few.
FrameCost cost_of_frame(const Scene& scene, const std::atomic<bool>& stop) {
    constexpr double sufficient_s = 0.1, slow_s = 2;
    const auto few = cost_of_frames(scene, 2, stop);
    FrameCost cost = few;
    for (double* part : {&cost.wall_s, &cost.cpu_s, &cost.bytes}) *part /= few.frames;
    cost.table_bytes /= std::max(few.rows, 1.0);
    for (long count = 8; count <= 128 && few.cpu_s < slow_s; count *= 4) {
        const auto many = cost_of_frames(scene, count, stop);
        const double more = many.frames - few.frames, wall_s = many.wall_s - few.wall_s;
        if (more < 1) break;
        cost.wall_s = std::max(wall_s, 0.0) / more;
        cost.cpu_s = std::max(many.cpu_s - few.cpu_s, 0.0) / more;
        cost.bytes = std::max(many.bytes - few.bytes, 0.0) / more;
        cost.key_bytes = std::max(few.bytes - few.frames * cost.bytes, 0.0);
        if (many.rows > few.rows) cost.table_bytes = (many.table_bytes - few.table_bytes) / (many.rows - few.rows);
        if (wall_s > sufficient_s) break;
    }
    return cost;
}

/// The cost of one sample of a page: the difference between a page of all samples and one of few. The rest, which does
/// not depend on the number of samples, is like a key frame.
FrameCost cost_of_page_sample(const Scene& scene, double simulate_s, const std::atomic<bool>& stop) {
    const auto beginning = beginning_of(scene, std::min(scene.samples, 2L));
    const auto few = cost_of_frames(beginning, beginning.frames.count, stop),
               many = cost_of_frames(scene, scene.frames.count, stop);
    const double more = std::max(many.rows - few.rows, 1.0),
                 each_s = std::max((many.run_s - few.run_s) / more - simulate_s, 0.0);
    return {.wall_s = each_s,
            .cpu_s = each_s,
            .bytes = (many.bytes - few.bytes) / more,
            .table_bytes = (many.table_bytes - few.table_bytes) / more,
            .run_s = few.run_s,
            .key_bytes = few.bytes};
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
    const double begin_s = is_page ? 2 : 0.6, patience_s = 1;  // a page draws nothing in the meantime
    const auto samples = static_cast<double>(scene.samples);
    // add_warnings() compares each side with two finer runs; measured on the presets
    constexpr double compared = 3;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    const double motions_s = simulation.seconds + seconds_of_members(scene, stop) * samples;
    const double sample_s = motions_s / samples;
    Needs estimate{.seconds = motions_s,
                   .cpu_s = motions_s,
                   .repeated_cpu_s = motions_s,
                   .disk_bytes = unknown,
                   .at_least = simulation.at_least};
    const auto second = scene.frames.at(std::min(1L, scene.frames.count - 1));
    const long one_frame = std::max(1L, second.sample + (second.share > 0 ? 1 : 0));
    if (!simulation.at_least && sample_s * static_cast<double>(one_frame) <= patience_s) {
        const double wanted = std::min(is_page ? samples : samples / 2, begin_s / std::max(sample_s, 1e-12));
        const auto begun = beginning_of(
            scene, std::clamp(static_cast<long>(wanted), std::min(one_frame, scene.samples), scene.samples));
        const auto cost = is_page ? cost_of_page_sample(begun, sample_s, stop) : cost_of_frame(begun, stop);
        const double frames = is_page ? samples : static_cast<double>(schedule_of(scene).frames());
        const double segments = is_page ? 1 : static_cast<double>(max_shards(scene));
        if (video.format_row().has_parts()) estimate.most_shards = max_shards(scene);
        estimate.seconds += cost.run_s + std::max(cost.wall_s * frames, cost.cpu_s * frames / cores());
        estimate.cpu_s += cost.run_s + cost.cpu_s * frames;
        const double checks_s =
            std::min(compared * motions_s, std::clamp(estimate.seconds, min_patience_s, max_patience_s));
        estimate.seconds += checks_s;
        estimate.cpu_s += checks_s;
        estimate.film_bytes = cost.bytes * frames + cost.key_bytes * segments;
        estimate.disk_bytes = cost.table_bytes * (samples + 1) + estimate.film_bytes;
    }
    const bool keeps_motion = depends_on_motion(scene) || video.contact_sheet;
    const double motion_bytes = recorded_bytes(scene, {scene.samples + 1});
    estimate.memory_bytes = peak_memory() + lookahead_bytes(video) +
                            (keeps_motion && motion_bytes <= Recording::usual_bytes ? motion_bytes : 0);
    return estimate;
}

}  // namespace doppel

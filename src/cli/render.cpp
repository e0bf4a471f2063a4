#include "base/error.hpp"
#include "cli/options.hpp"
#include "film/film.hpp"
#include "film/recording.hpp"
#include "fit/start.hpp"
#include "scene/resolved.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <numbers>

namespace doppel {
namespace {

struct RenderOptions : RunCommandOptions {
    std::string frames, from, to, size, format, quality, shard;
    Gl gl = Gl::automatic;
    bool merge = false;
};

struct StillOptions : PresetOptions, OutOptions {
    std::string at, size;
    PictureFormat format = PictureFormat::png;
    Gl gl = Gl::automatic;
};

void add_beside_option(CLI::App& command, PresetOptions& options) {
    add_value(command, "--beside", options.beside, "TRACK",
              "A measured track (CSV) as side a; side b starts as it does, fitted to its\n"
              "first two seconds, and runs as long");
}

void add_columns_option(CLI::App& command, std::string& columns) {
    add_value(command, "--columns", columns, "LIST",
              "Only these columns of the CSV, time_s,a,distance; a, b: all of a side");
}

std::vector<std::string> columns_of_option(const std::string& text) {
    std::vector<std::string> names;
    if (!text.empty())
        for (const auto& name : CLI::detail::split(text, ',')) names.push_back(CLI::detail::trim_copy(name));
    return names;
}

void add_recording_option(CLI::App& command, std::string& file, const std::string& help) {
    refuse_dash(add_value(command, "--recording", file, "FILE", help));
}

/// Notes that a run ends at a gap of its track, which goes on after it.
void note_gap(const Scene& scene, ProgressReport& report) {
    for (const char letter : scene.letters()) {
        const auto& replay = scene.side(letter).replay;
        if (!replay || replay->piece + 1 == replay->track->pieces.size()) continue;
        if (scene.preset.duration_s != longest_duration(*replay, scene.preset.sample_hz)) continue;
        const auto& next = replay->track->pieces[replay->piece + 1];
        report.note(
            fmt::format("side {0}: the run ends at a gap of the track, from {1} to {2} s; the rest: --set "
                        "{0}.track.start_s={2}",
                        letter, replay->samples().time_s.back(), next.time_s.front()));
    }
}

/// Runs the scenes one after the other and reports progress.
void run_all(const std::vector<Scene>& scenes, const RunCommandOptions& options, RunOptions run_options) {
    run_options.replacing = {inputs_of(options.presets, scenes), options.force, options.out == "-"};
    const auto& stop = watch_interrupts();
    for (const auto& scene : scenes) check_run(scene, run_options);
    if (scenes.size() > 1 && !options.recording.empty())
        throw bad_input("--recording: a file contains one motion; give one preset, not {}", scenes.size());
    const auto& video = scenes.front().preset.video;
    const bool is_sequence = run_options.pictures && video.format == FilmFormat::png;
    if (options.out == "-" && is_sequence)
        throw bad_input("-o -: a PNG sequence is many files; give --format apng, or use still for one picture");
    const Destination to(options, scenes.size(),
                         run_options.pictures ? fmt::format(".{}", name_of(video.format)) : ".csv");
    if (options.list_outputs) {
        for (const auto& scene : scenes) list_outputs(options, scene.preset.name, run_files(scene, run_options));
        if (!run_options.pictures && !options.recording.empty()) print_line("{}", options.recording);
        return;
    }
    run_options.out = to.folder;
    run_options.to_stream =
        options.out == "-" && run_options.pictures && !run_options.merge && video.format_row().is_streamed();
    std::optional<SingleFile> recording;
    if (!run_options.pictures && !options.recording.empty())
        run_options.record_to = recording.emplace(options.recording, recording_file.start).place;
    const bool counts_frames = run_options.pictures && video.format != FilmFormat::html;
    work_on_all(scenes, options.progress, counts_frames ? "frames" : "samples", to.streamed,
                [&](const Scene& scene, ProgressReport& report) {
                    note_gap(scene, report);
                    auto result = run(scene, run_options, stop, std::ref(report));
                    if (recording) {
                        recording->parts.publish();
                        if (options.out != "-") result.files.push_back(options.recording);
                    }
                    report.done(result);
                });
}

/// Sets the range from --frames, or from --from and --to.
void set_range(const RenderOptions& options, RunOptions& run) {
    if (!options.from.empty()) run.from_s = seconds_of_option("--from", options.from);
    if (!options.to.empty()) run.to_s = seconds_of_option("--to", options.to);
    if (options.frames.empty()) return;
    if (run.from_s || run.to_s) throw bad_input("--frames counts frames, --from and --to seconds; give one");
    std::tie(run.first, run.last) = frames_of_option(options.frames);
}

/// How the other pendulum is integrated while its start is fitted: with the preset's method, or by Taylor series if the
/// preset requires an accuracy.
MotionSpec simulated_motion(SideSpec side, const Rational& sample_hz) {
    if (side.accuracy) {
        side.accuracy.reset();
        side.integrator = "taylor";
        side.tolerance = parse_quad("1e-9");
    }
    return make_side(side, sample_hz).motion;
}

std::string degrees_list(const std::array<double, 2>& radians) {
    constexpr double degree = std::numbers::pi / 180;
    return fmt::format("[{:.9g}, {:.9g}]", radians[0] / degree, radians[1] / degree);
}

/// The overrides that --beside FILE puts on top of a preset and of the overrides `given`; these are included in the
/// result. Side a shows the track. Side b starts from a fit to the track's first two seconds, and runs as long as the
/// track. Throws Error as read_preset() does.
std::vector<Override> beside_overrides(const PresetText& text, const std::vector<Override>& given,
                                       const std::string& track, const std::atomic<bool>& stop) {
    auto all = given;
    const auto is_given = [&](std::string_view key) {
        return std::any_of(given.begin(), given.end(), [&](const Override& one) {
            return one.key.substr(0, one.key.find('[')) == key;  // also one element
        });
    };
    const auto add = [&](const char* key, const std::string& value) {
        if (!is_given(key)) all.push_back({key, value, fmt::format("--beside {} ({})", track, key)});
    };
    add("a.track.file", toml_text(track));
    const auto preset = read_preset(text, all);
    const auto replay = replay_of(preset.a.track);
    if (preset.duration_s.value() > replay.length())
        add("scene.duration_s", toml_ratio(longest_duration(replay, preset.sample_hz)));
    if (is_given("b.angle_deg") || is_given("b.omega_deg_per_s")) return all;
    const auto start = fit_start(simulated_motion(preset.b, preset.sample_hz), replay, stop);
    add("a.track.offset_deg", degrees_list(start.offset));
    add("b.angle_deg", degrees_list(start.angle));
    add("b.omega_deg_per_s", degrees_list(start.rate));
    const auto words = start.seconds == 0 ? "starts as the first samples do"
                                          : fmt::format("start fitted to {:.2g} s, within {:.2g} mrad", start.seconds,
                                                        1000 * start.rms);
    if (!preset.b.note) add("b.note", toml_text(words));
    return all;
}

}  // namespace

std::vector<Scene> read_scenes(const PresetOptions& options, ProgressStyle progress,
                               const std::vector<Override>& more) {
    const auto overrides = overrides_of(options, more);
    const auto& stop = watch_interrupts();
    std::vector<Scene> scenes;
    std::vector<std::string> names;
    for (const auto& name : options.presets) {
        const auto text = find_preset(name, &stop);
        const auto& all = options.beside.empty() ? overrides : beside_overrides(text, overrides, options.beside, stop);
        auto preset = read_preset(text, all);
        preset.certify = preset.certify && options.wants_proof;
        ProgressReport report(progress, preset.name, "samples");
        scenes.push_back(make_scene(preset, stop, std::bind_front(&ProgressReport::of_proof, &report)));
        names.push_back(scenes.back().preset.name);
        check_names(names, options.presets);
    }
    return scenes;
}

std::vector<std::filesystem::path> inputs_of(const std::vector<std::string>& presets,
                                             const std::vector<Scene>& scenes) {
    std::vector<std::filesystem::path> inputs;
    for (const auto& name : presets)
        if (std::error_code error; std::filesystem::is_regular_file(name, error)) inputs.emplace_back(name);
    for (const auto& scene : scenes) {
        const auto& preset = scene.preset;
        for (const auto* side : {&preset.a, &preset.b})
            if (!side->track.is_none()) inputs.emplace_back(side->track.file);
        if (preset.video.text_font) inputs.emplace_back(*preset.video.text_font);
    }
    return inputs;
}

void work_on_all(const std::vector<Scene>& scenes, ProgressStyle progress, const std::string& unit,
                 const std::string& streamed, const std::function<void(const Scene&, ProgressReport&)>& work) {
    ignore_sigpipe();
    for (const auto& scene : scenes) {
        ProgressReport report(progress, scene.preset.name, unit, streamed);
        work(scene, report);
    }
}

void add_render(CLI::App& app) {
    auto options = std::make_shared<RenderOptions>();
    auto& command = *app.add_subcommand("render", "Renders presets to films: video or PNG sequence, CSV and manifest");
    command.footer(
        "Examples:\n"
        "  doppel render butterfly\n"
        "  doppel render calm --size 1280x720 --format png --frames 0:240\n"
        "  doppel render butterfly --from 6.8 --to 9\n"
        "  doppel render fan --size 3840x2160 --shard 3/8        # on one of eight machines; then --merge\n"
        "  doppel render calm --format webm -o - | mpv -");
    add_run_options(command, *options, "Threads that compress PNGs; default: one a core; same bytes for any N");
    command.get_option("--out")->description("Results: DIR/NAME/; -: standard output; mp4, webm, y4m, rgb while drawn");
    add_value(command, "--frames", options->frames, "A:B",
              "Only the frames A to B-1 of the motion, with the pixels of the whole film");
    add_value(command, "--from", options->from, "SECONDS", "Start time, s");
    add_value(command, "--to", options->to, "SECONDS", "End time, s, not included: --to 20 makes 20 s");
    add_value(command, "--shard", options->shard, "I/N", "Draw shard I of N only, for --merge");
    command.add_flag("--merge", options->merge, "Join the parts in DIR/NAME/ into the film");
    add_recording_option(command, options->recording, "Take the motion from simulate --recording FILE");
    add_value(command, "--size", options->size, "WxH", "Size of the picture, px, even");
    add_value(command, "--format", options->format, "FORMAT",
              "png: a sequence; html: a page to use in a browser; y4m, rgb: raw")
        ->check(CLI::IsMember(Choices{format_names.begin(), format_names.end()}));
    add_quality_option(command, options->quality);
    add_beside_option(command, *options);
    add_columns_option(command, options->columns);
    add_gl_option(command, options->gl);
    command.callback([options] {
        RunOptions run{
            .pictures = true, .jobs = options->jobs, .gl = options->gl, .columns = columns_of_option(options->columns)};
        set_range(*options, run);
        run.shard = shard_of_option(options->shard, options->merge);
        run.merge = options->merge;
        run.recording = options->recording;
        if (options->out == "-" && (run.shard || run.merge))
            throw bad_input("-o -: parts and their merge need a folder; give another --out");
        const auto scenes = read_scenes(*options, options->progress,
                                        picture_overrides("video", options->size, options->format, options->quality));
        // before the first one is rendered
        for (const auto& scene : scenes) check_encoder(video_options(scene));
        run_all(scenes, *options, run);
    });
}

void add_still(CLI::App& app) {
    auto options = std::make_shared<StillOptions>();
    auto& command = *app.add_subcommand("still", "Draws one picture of a film: DIR/NAME/NAME.14s.png, or PDF, or SVG");
    command.footer(
        "Examples:\n"
        "  doppel still butterfly --at 14 --size 3840x2160\n"
        "  doppel still butterfly --at 14 --set video.transparent=true\n"
        "  doppel still butterfly --at 14 --format pdf\n"
        "  doppel still butterfly --at 14 -o - > butterfly.png");
    add_preset_options(command, *options);
    add_beside_option(command, *options);
    add_value(command, "--at", options->at, "SECONDS", "The time of the picture, s")->required();
    add_out_options(command, *options);
    add_value(command, "--size", options->size, "WxH", "Size of the picture, px");
    add_choice(command, "--format", options->format, "FORMAT", "Format of the picture", {"png", "pdf", "svg"});
    add_gl_option(command, options->gl);
    command.callback([options] {
        const auto at = seconds_of_option("--at", options->at);
        auto more = picture_overrides("video", options->size);
        more.push_back({"video.format", "\"png\"", "--format of still, which draws PNG"});
        const auto scenes = read_scenes(*options, options->progress, more);
        const Destination to(*options, scenes.size(), fmt::format(".{}", name_of(options->format)));
        for (const auto& scene : scenes)
            if (const auto name = still_name(scene, at, options->format); options->list_outputs)
                list_outputs(*options, scene.preset.name, {name});
        if (options->list_outputs) return;
        const RunOptions run{.out = to.folder,
                             .gl = options->gl,
                             .replacing = {inputs_of(options->presets, scenes), options->force, options->out == "-"}};
        const auto& stop = watch_interrupts();
        work_on_all(scenes, options->progress, "samples", to.streamed, [&](const Scene& scene, auto& report) {
            report.done(draw_still(scene, at, options->format, run, stop, std::ref(report)));
        });
    });
}

void add_simulate(CLI::App& app) {
    auto options = std::make_shared<RunCommandOptions>();
    auto& command = *app.add_subcommand("simulate", "Runs presets without pictures: CSV and manifest, no OpenGL");
    command.footer(
        "Examples:\n"
        "  doppel simulate butterfly --set system.integrator=rk4\n"
        "  doppel simulate butterfly --columns time_s,a_theta2_rad,distance\n"
        "  doppel simulate butterfly -o - | head");
    add_run_options(command, *options, "Has no effect on a table");
    add_beside_option(command, *options);
    add_columns_option(command, options->columns);
    add_recording_option(command, options->recording, "Also writes the motion to FILE, for render --recording");
    command.callback([options] {
        const RunOptions run{.pictures = false, .jobs = options->jobs, .columns = columns_of_option(options->columns)};
        run_all(read_scenes(*options, options->progress), *options, run);
    });
}

}  // namespace doppel

#include "base/machine.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "cli/options.hpp"
#include "figure/computation.hpp"
#include "film/estimate.hpp"
#include "film/film.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"
#include "scene/forecast.hpp"
#include "scene/method_choice.hpp"
#include "scene/side_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

namespace doppel {
namespace {

constexpr const char* unsettled_words = "parts of the run differ by more than chance: this ± may be too small";

/// "H.264 veryfast, crf 18, yuv420p", "PNG sequence", "GIF".
std::string format_words(const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto& row = video.format_row();
    if (!row.is_encoded()) return std::string(row.title);
    return fmt::format("{} {}, crf {}, {}", row.title, video.preset, video.crf, name_of(video.pixel_format));
}

/// "1 800 000", for numbers of any size.
std::string counted(double number) {
    constexpr double maximum = 1e18;
    return number < maximum ? grouped(std::llround(number)) : scientific(number);
}

/// What check tells: lines for people, and the same as JSON for programs.
struct Findings {
    Findings(const PresetText& preset, const std::string& title) {
        std::error_code ignored;
        const bool is_file = std::filesystem::exists(preset.path, ignored);
        json = {{"name", preset.name},
                {"title", title},
                {"kind", kind_of_preset(preset)},
                {"path", is_file ? Json(preset.path) : Json(nullptr)}};
        line("{}: {}", preset.name, title);
    }

    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        lines += on_one_line(fmt::format(format, std::forward<Args>(args)...)) + "\n";
    }

    Json json;
    Json warnings = Json::array();
    std::string lines = {};
};

std::string_view unit_of_errors(const Side& side) {
    return side.has_angles ? "rad" : "of its size";
}

std::string_view precision_of(const Side& side) {
    return side.motion.precision == Precision::in_quad ? "quad" : "double";
}

/// How long a side keeps the accuracy that it was chosen for.
std::string accuracy_words(const Scene& scene, const Side& side) {
    const auto& choice = *side.choice;
    const auto unit = unit_of_errors(side);
    if (choice.horizon >= scene.samples)
        return fmt::format("error at most {} {} to the end; verified by {}", scientific(choice.estimated_error), unit,
                           choice.reference->description());
    return fmt::format("error below {} {} up to {} s; {}", scientific(choice.accuracy), unit,
                       with_digits(scene.time(choice.horizon), 3),
                       choice.reference->failure.empty()
                           ? fmt::format("no setting keeps it much longer in {}", precision_of(side))
                           : "not known beyond");
}

/// The expected error of a side, and the predictability limit of its precision.
Json add_forecast(Findings& found, const Scene& scene, char letter, const Forecast& seen) {
    const auto& side = scene.side(letter);
    Json json{{"error", seen.error},
              {"unit", side.has_angles ? "rad" : "its size"},
              {"at_s", seen.error_s},
              {"off_from_s", nullptr}};
    if (seen.is_off()) json["off_from_s"] = seen.error_s;
    const auto warn = [&](const std::string& words) {
        found.warnings.push_back(fmt::format("side {}: {}", letter, words));
    };
    if (side.choice) {
        found.line("         {}", accuracy_words(scene, side));
    } else if (seen.is_off()) {
        found.line("         {}", error_words(side, seen.error_s));
        warn(error_words(side, seen.error_s));
    } else {
        found.line("         error at most about {} {} up to {}", scientific(seen.error), unit_of_errors(side),
                   seen.error_s < scene.time(scene.samples) ? with_digits(seen.error_s, 3) + " s; not known beyond"
                                                            : "the end");
    }
    if (seen.exponent) {
        const auto& [value, uncertainty, is_settled] = *seen.exponent;
        const auto tenfold = two_digits(std::log(10) / value);
        switch (seen.kind) {
            case Forecast::Kind::regular:
                json["motion"] = "regular";
                found.line("         regular: the Lyapunov exponent is not above 0 ({:.2g} ± {:.1g} 1/s)", value,
                           uncertainty);
                break;
            case Forecast::Kind::chaotic:
                json["motion"] = "chaotic";
                found.line("         chaotic: errors grow tenfold every {} s (Lyapunov exponent {:.2g} ± {:.1g} 1/s)",
                           tenfold, value, uncertainty);
                if (is_settled) break;
                found.line("         {}", unsettled_words);
                warn(unsettled_words);
                break;
            case Forecast::Kind::unstable:
                json["motion"] = "unstable";
                found.line(
                    "         released at an unstable equilibrium: near it errors grow tenfold every {} s "
                    "(exponent {:.2g} 1/s); this alone is not chaos",
                    tenfold, value);
        }
        json["exponent_per_s"] = {{"value", value}, {"uncertainty", uncertainty}, {"settled", is_settled}};
    }
    json["limit_s"] = nullptr;
    if (!seen.limit) return json;
    json["limit_s"] = {seen.limit->from, seen.limit->to};
    const auto from = two_digits(seen.limit->from), to = two_digits(seen.limit->to);
    found.line("         predictability limit in {}: about {}{} s", precision_of(side), from,
               from == to ? "" : " to " + to);
    return json;
}

/// The work for half or ten times the accuracy, compared with the required one.
std::vector<std::string> alternatives_of(const Scene& scene, char letter, const std::atomic<bool>& stop) {
    std::vector<std::string> all;
    const auto& choice = *scene.side(letter).choice;
    for (const auto& [factor, title] : {std::pair(2.0, "half"), {0.1, "ten times"}}) {
        if (factor * choice.accuracy > 1) continue;
        std::string words = "is out of reach";
        try {
            const auto alternatives = scene.chooser->choose(factor, stop);
            const auto& alternative = *alternatives[letter == 'a' ? 0 : 1];
            // if round-off limits how long it is accurate, it determines the work, too
            words = alternative.choice->horizon < scene.samples
                        ? fmt::format("is kept up to {} s", with_digits(scene.time(alternative.choice->horizon), 3))
                        : fmt::format("takes {:.2f} times the work ({}, {})", alternative.choice->work / choice.work,
                                      alternative.method.name, step_control_text(alternative));
        } catch (const Error& error) {
            if (error.code() != ExitCode::bad_input) throw;
        }
        all.push_back(fmt::format("{} the accuracy, {} {}, {}", title, scientific(factor * choice.accuracy),
                                  unit_of_errors(scene.side(letter)), words));
    }
    return all;
}

/// Adds what a run takes, and how it is best split for a cluster: into shards of half an hour of one core, or less.
void add_needs(Findings& found, const std::optional<Needs>& needs) {
    constexpr double job_s = 1800, worth_a_word = 0.02;
    auto& json = found.json;
    for (const char* key :
         {"cpu_s", "memory_bytes", "disk_bytes", "shards", "array", "shard_cpu_s", "shard_repeated_share"})
        json[key] = nullptr;
    if (!needs) return;
    const bool knows_disk = !std::isnan(needs->disk_bytes);
    found.line("  needs  {} {} of CPU time, {} of memory{}", needs->at_least ? "more than" : "about",
               duration_text(needs->cpu_s), bytes_text(needs->memory_bytes),
               knows_disk ? fmt::format(", {} of disk", bytes_text(needs->disk_bytes)) : "");
    const double once = needs->repeated_cpu_s, rest = needs->cpu_s - once;
    const double wanted = needs->cpu_s <= job_s ? 1 : std::ceil(rest / std::max(job_s - once, once));
    const long shards = std::lround(std::clamp(wanted, 1.0, std::max(1.0, static_cast<double>(needs->most_shards))));
    const double shard_s = once + rest / static_cast<double>(shards);
    const double repeated_share = shard_s > 0 ? once / shard_s : 0;
    if (shards > 1)
        found.line("  split  into {} shards, each about {} of one core: --array=1-{}{}", grouped(shards),
                   duration_text(shard_s), shards,
                   repeated_share < worth_a_word
                       ? ""
                       : fmt::format("; each simulates the motion again, {:.0f} % of its time; a recording saves it",
                                     100 * repeated_share));
    json["cpu_s"] = needs->cpu_s;
    json["memory_bytes"] = std::llround(needs->memory_bytes);
    if (knows_disk) json["disk_bytes"] = std::llround(needs->disk_bytes);
    json["shards"] = shards;
    if (needs->most_shards > 0) json["array"] = fmt::format("1-{}", shards);
    json["shard_cpu_s"] = shard_s;
    json["shard_repeated_share"] = repeated_share;
}

/// The forecasts of the sides, as far as they take little time.
std::vector<std::optional<Forecast>> forecasts_of(const Scene& scene, const SimulationEstimate& simulation,
                                                  const std::atomic<bool>& stop) {
    constexpr double patience = 2, longest = 6;  // s: runs that only give information; finding what they give
    const auto letters = scene.letters();
    std::vector<std::optional<Forecast>> forecasts(letters.size());
    if (simulation.at_least || simulation.seconds >= patience) return forecasts;
    const TimeLimit limit(longest, stop);
    parallel_for(letters.size(), cores(), [&](std::size_t i) {
        const auto& side = scene.side(letters[i]);
        if (side.replay) return;
        try {
            forecasts[i] = forecast_of(scene, side, limit.reached());
        } catch (const Error& error) {
            throw_if_set(stop);
            if (error.code() != ExitCode::interrupted) throw;  // otherwise unknown: it takes too long
        }
    });
    return forecasts;
}

void add_side(Findings& found, const Scene& scene, char letter, const std::vector<std::string>& alternatives,
              const std::optional<Forecast>& forecast) {
    const auto& side = scene.side(letter);
    auto& json = found.json[std::string(1, letter)];
    if (side.replay) {
        json = {{"model", "track"},
                {"why", side.why},
                {"file", (letter == 'a' ? scene.preset.a : scene.preset.b).track.file}};
        return found.line("  {}      {}", letter, side.why);
    }
    const auto steps = side.method.adaptive ? std::string("its own steps")
                                            : fmt::format("{} step{} a sample", grouped(side.motion.steps_per_sample),
                                                          side.motion.steps_per_sample == 1 ? "" : "s");
    found.line("  {}      {}, {}, {}, {}", letter, name_of(side.motion.model), side.method.title,
               step_control_text(side), steps);
    found.line("         {}: {}", name_of(side.motion.model), side.why);
    json = method_json(scene, side);
    json["precision"] = precision_of(side);
    json["forecast"] = forecast ? add_forecast(found, scene, letter, *forecast) : Json(nullptr);
    for (const auto& alternative : alternatives) found.line("         {}", alternative);
    if (side.choice) json["other_accuracies"] = alternatives;
}

void check_film(Findings& found, const Scene& scene, const std::atomic<bool>& stop) {
    check_encoder(video_options(scene));
    reset_peak_memory();
    const auto simulation = estimated_simulation(scene, stop);
    std::optional<Needs> render;
    std::string why_not;
    try {
        render = estimated_render(scene, simulation, stop);
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        why_not = error.what();
    }
    const auto letters = scene.letters();
    std::vector<std::vector<std::string>> alternatives(letters.size());
    for (std::size_t i = 0; i < letters.size(); ++i)
        if (scene.side(letters[i]).choice) alternatives[i] = alternatives_of(scene, letters[i], stop);
    const auto forecasts = forecasts_of(scene, simulation, stop);
    for (std::size_t i = 0; i < letters.size(); ++i) add_side(found, scene, letters[i], alternatives[i], forecasts[i]);
    if (const auto words = no_difference(scene)) {
        found.line("  pair   {}", *words);
        found.warnings.push_back(*words);
    }
    if (scene.certificate)
        for (const auto& sentence : certificate_words(scene, *scene.certificate)) found.line("  proof  {}", sentence);

    auto& json = found.json;
    const auto& video = scene.preset.video;
    const bool is_exact = !scene.a.method.adaptive && !scene.b.method.adaptive;
    const auto at_least = simulation.at_least ? "more than" : "about";
    const double duration_s = scene.preset.duration_s.value();
    found.line("  time   {} s: samples 0 to {} at {} Hz, {}{} steps in all", duration_s, scene.samples,
               scene.preset.sample_hz.text(), is_exact ? "" : fmt::format("{} ", at_least), counted(simulation.steps));
    json["duration_s"] = duration_s;
    json["sample_hz"] = scene.preset.sample_hz.value();
    json["samples"] = scene.samples + 1;
    json["steps"] = simulation.steps;
    json["steps_are_exact"] = is_exact;
    const auto& every = scene.frames.stride;  // samples per frame
    const auto frames = schedule_of(scene).frames();
    const double fps = scene.fps.value();
    found.line("  video  {} frames of {}×{} at {:.6g} frames/s{}, {}{}", grouped(frames), video.size.width,
               video.size.height, fps,
               every.is_whole() && every.numerator > 1 ? fmt::format(" (one in {} samples)", every.numerator) : "",
               format_words(scene),
               render && render->film_bytes > 0 ? fmt::format(", about {}", bytes_text(render->film_bytes)) : "");
    json["frames"] = frames;
    json["fps"] = fps;
    json["size"] = {video.size.width, video.size.height};
    json["format"] = name_of(video.format);
    json["encoding"] = format_words(scene);
    found.line("  takes  {} {} to simulate, {}", at_least, duration_text(simulation.seconds),
               render ? duration_text(render->seconds) + " to render" : "time to render unknown: " + why_not);
    json["simulate_s"] = simulation.seconds;
    json["render_s"] = render ? Json(render->seconds) : Json(nullptr);
    json["times_are_least"] = simulation.at_least;
    add_needs(found, render);
    if (scene.certificate) json["certificate"] = certificate_json(scene, *scene.certificate);
    json["horizon_s"] = scene.horizon() ? Json(*scene.horizon()) : Json(nullptr);
}

void check_figure(Findings& found, const FigurePreset& figure, const std::atomic<bool>& stop) {
    const auto& experiment = *figure.experiment;
    const int threads = experiment.measures_time() ? 1 : cores();
    const auto trials = experiment.trials();
    double units = 0;
    for (std::size_t trial = 0; trial < trials; ++trial) units += experiment.units(trial);
    reset_peak_memory();
    const auto needs = estimated_computation(figure, threads, stop);
    const auto layout = layout_of(figure.chart);
    const auto [width, height] = layout.picture;
    constexpr double cm_per_pt = 2.54 / 72;
    const double width_cm = cm_per_pt * layout.width_pt;
    const auto format = name_of(figure.chart.format);
    found.line("  kind   {}: {} trial{}; {}: {}", figure.kind, grouped(static_cast<long>(trials)),
               trials == 1 ? "" : "s", experiment.unit(), grouped(std::lround(units)));
    if (figure.chart.format == PictureFormat::html && !figure.chart.width_cm)
        found.line("  chart  {}×{} px, {}, {}", figure.chart.size.width, figure.chart.size.height, format,
                   figure.chart.theme);
    else if (figure.chart.width_cm || figure.chart.format != PictureFormat::png)
        found.line("  chart  {:.3g}×{:.3g} cm, {}, {}", width_cm, width_cm * height / width, format,
                   figure.chart.theme);
    else
        found.line("  chart  {}×{} px, {}", width, height, figure.chart.theme);
    found.line("  takes  {} {} on {} thread{}, {} {}/s", needs.at_least ? "more than" : "about",
               duration_text(needs.seconds), threads, threads == 1 ? "" : "s", two_digits(units / needs.seconds),
               experiment.unit());
    found.json.update({{"trials", trials},
                       {"units", units},
                       {"unit", experiment.unit()},
                       {"size", {width, height}},
                       {"width_pt", layout.width_pt},
                       {"format", format},
                       {"theme", figure.chart.theme},
                       {"threads", threads},
                       {"compute_s", needs.seconds},
                       {"times_are_least", needs.at_least}});
    add_needs(found, needs);
}

struct CheckOptions : PresetOptions {
    std::string size, format, quality;
    bool as_json = false;
};

void check_presets(const CheckOptions& options) {
    const auto& stop = watch_interrupts();
    auto all = Json::array();
    for (const auto& name : options.presets) {
        const auto preset = find_preset(name, &stop);
        const auto wrong_schema = schema_line_error(preset);
        if (wrong_schema && !options.as_json) print_line("{}", *wrong_schema);
        const bool is_chart = is_figure(preset);
        const auto overrides = overrides_of(
            options, picture_overrides(is_chart ? "chart" : "video", options.size, options.format, options.quality));
        const auto report = [&](const std::string& title, const auto& add, const auto& checked) {
            Findings found(preset, title);
            if (wrong_schema) found.warnings.push_back(*wrong_schema);
            add(found, checked, stop);
            found.json["warnings"] = found.warnings;
            all.push_back(found.json);
            if (!options.as_json) write_out(found.lines);
        };
        if (is_chart) {
            const auto figure = read_figure(preset, overrides, stop);
            report(figure.title, check_figure, figure);
        } else {
            ProgressReport progress(ProgressStyle::automatic, preset.name, "samples");
            const auto scene =
                make_scene(read_preset(preset, overrides), stop, std::bind_front(&ProgressReport::of_proof, &progress));
            progress.clear();
            report(scene.preset.title, check_film, scene);
        }
    }
    if (options.as_json) print_json(all);
}

}  // namespace

void add_check(CLI::App& app) {
    auto options = std::make_shared<CheckOptions>();
    auto& command = *app.add_subcommand("check", "Shows what a preset would run: model, method, errors, steps, time");
    command.footer(
        "Examples:\n"
        "  doppel check butterfly\n"
        "  doppel check butterfly --set system.accuracy=1e-6    the cheapest way to this error, rad\n"
        "  doppel check flip-map                                cost of a figure\n"
        "  doppel check butterfly --json | jq '.[0].warnings'");
    add_preset_options(command, *options);
    add_value(command, "--size", options->size, "WxH", "Size of the picture, px");
    Choices formats{format_names.begin(), format_names.end()};
    formats.insert(formats.end(), {"pdf", "svg"});  // of figures
    add_value(command, "--format", options->format, "FORMAT", "Format, as render or figure takes it")
        ->check(CLI::IsMember(formats));
    add_quality_option(command, options->quality);
    command.add_flag("--json", options->as_json,
                     "The same as JSON, an array with an object a preset: see docs/files.md");
    command.callback([options] { check_presets(*options); });
}

}  // namespace doppel

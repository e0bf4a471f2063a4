#include "base/machine.hpp"
#include "base/text.hpp"
#include "base/threads.hpp"
#include "cli/options.hpp"
#include "figure/computation.hpp"
#include "film/estimate.hpp"
#include "film/film.hpp"
#include "film/page.hpp"
#include "scene/captions.hpp"
#include "scene/certificate.hpp"
#include "scene/forecast.hpp"
#include "scene/method_choice.hpp"
#include "scene/side_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

namespace doppel {
namespace {

constexpr const char* unsettled_words = "parts of the run differ by more than chance: this ± may be too small";

/// "H.264 veryfast, crf 18, yuv420p", "PNG sequence", "GIF".
std::string format_words(const Scene& scene) {
    const auto& video = scene.preset.video;
    const auto& row = video.format_row();
    if (video.format == FilmFormat::html)
        return fmt::format("{} of about {}", row.title, bytes_text(estimated_page_bytes(scene)));
    if (!row.is_encoded()) return std::string(row.title);
    return fmt::format("{} {}, crf {}, {}", row.title, video.preset, video.crf, name_of(video.pixel_format));
}

/// "1 800 000", for numbers of any size.
std::string counted(double number) {
    constexpr double maximum = 1e18;
    return number < maximum ? grouped(std::llround(number)) : scientific(number);
}

void print_side(char name, const Side& side) {
    if (side.replay) return print_line("  {}      {}", name, side.why);
    const auto steps = side.method.adaptive ? std::string("its own steps")
                                            : fmt::format("{} step{} a sample", grouped(side.motion.steps_per_sample),
                                                          side.motion.steps_per_sample == 1 ? "" : "s");
    print_line("  {}      {}, {}, {}, {}", name, name_of(side.motion.model), side.method.title, step_control_text(side),
               steps);
    print_line("         {}: {}", name_of(side.motion.model), side.why);
}

std::string_view unit_of_errors(const Side& side) {
    return side.has_angles ? "rad" : "of its size";
}

/// The expected error of a side, and the predictability limit of its precision.
void print_forecast(const Scene& scene, const Side& side, const Forecast& seen) {
    const auto unit = unit_of_errors(side);
    const auto precision = side.motion.precision == Precision::in_quad ? "quad" : "double";
    const auto print_indented = [](const std::string& words) { print_line("         {}", words); };
    if (side.choice && side.choice->horizon < scene.samples)
        print_indented(fmt::format("error below {} {} up to {} s; {}", scientific(side.choice->accuracy), unit,
                                   with_digits(scene.time(side.choice->horizon), 3),
                                   side.choice->reference->failure.empty()
                                       ? fmt::format("no setting keeps it much longer in {}", precision)
                                       : "not known beyond"));
    else if (side.choice)
        print_indented(fmt::format("error at most {} {} to the end; verified by {}",
                                   scientific(side.choice->estimated_error), unit,
                                   side.choice->reference->description()));
    else if (seen.is_off())
        print_indented(error_words(side, seen.error_s));
    else
        print_indented(fmt::format("error at most about {} {} up to {}", scientific(seen.error), unit,
                                   seen.error_s < scene.time(scene.samples)
                                       ? with_digits(seen.error_s, 3) + " s; not known beyond"
                                       : "the end"));
    if (seen.exponent) {
        const auto& [value, uncertainty, is_settled] = *seen.exponent;
        const double tenfold = std::log(10) / value;
        switch (seen.kind) {
            case Forecast::Kind::regular:
                print_indented(fmt::format("regular: the Lyapunov exponent is not above 0 ({:.2g} ± {:.1g} 1/s)", value,
                                           uncertainty));
                break;
            case Forecast::Kind::chaotic:
                print_indented(
                    fmt::format("chaotic: errors grow tenfold every {} s (Lyapunov exponent {:.2g} ± {:.1g} 1/s)",
                                two_digits(tenfold), value, uncertainty));
                if (!is_settled) print_indented(unsettled_words);
                break;
            case Forecast::Kind::unstable:
                print_indented(
                    fmt::format("released at an unstable equilibrium: near it errors grow tenfold every {} s "
                                "(exponent {:.2g} 1/s); this alone is not chaos",
                                two_digits(tenfold), value));
        }
    }
    if (seen.limit) {
        const auto from = two_digits(seen.limit->from), to = two_digits(seen.limit->to);
        print_indented(
            fmt::format("predictability limit in {}: about {}{} s", precision, from, from == to ? "" : " to " + to));
    }
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

/// How a run is best split for a cluster: shards that take half an hour of one core, or less.
struct Split {
    long shards = 1;
    double shard_s, repeated_share;  // CPU time of a shard, and the share of what every shard does again
};

Split split(const Needs& needs) {
    constexpr double job_s = 1800;
    const double once = needs.repeated_cpu_s, rest = needs.cpu_s - once;
    const double wanted = needs.cpu_s <= job_s ? 1 : std::ceil(rest / std::max(job_s - once, once));
    Split split{std::lround(std::clamp(wanted, 1.0, std::max(1.0, static_cast<double>(needs.most_shards)))), 0, 0};
    split.shard_s = once + rest / static_cast<double>(split.shards);
    split.repeated_share = split.shard_s > 0 ? once / split.shard_s : 0;
    return split;
}

void print_needs(const Needs& needs) {
    print_line("  needs  {} {} of CPU time, {} of memory{}", needs.at_least ? "more than" : "about",
               duration_text(needs.cpu_s), bytes_text(needs.memory_bytes),
               std::isnan(needs.disk_bytes) ? "" : fmt::format(", {} of disk", bytes_text(needs.disk_bytes)));
    const auto [shards, shard_s, repeated_share] = split(needs);
    if (shards == 1) return;
    constexpr double worth_a_word = 0.02;
    print_line("  split  into {} shards, each about {} of one core: --array=1-{}{}", grouped(shards),
               duration_text(shard_s), shards,
               repeated_share < worth_a_word
                   ? ""
                   : fmt::format("; each simulates the motion again, {:.0f} % of its time; a recording saves it",
                                 100 * repeated_share));
}

/// Adds `needs` to the JSON of a preset; null for what is unknown.
void add_needs(Json& json, const std::optional<Needs>& needs) {
    for (const char* key :
         {"cpu_s", "memory_bytes", "disk_bytes", "shards", "array", "shard_cpu_s", "shard_repeated_share"})
        json[key] = nullptr;
    if (!needs) return;
    const auto [shards, shard_s, repeated_share] = split(*needs);
    json["cpu_s"] = needs->cpu_s;
    json["memory_bytes"] = std::llround(needs->memory_bytes);
    if (!std::isnan(needs->disk_bytes)) json["disk_bytes"] = std::llround(needs->disk_bytes);
    json["shards"] = shards;
    if (needs->most_shards > 0) json["array"] = fmt::format("1-{}", shards);
    json["shard_cpu_s"] = shard_s;
    json["shard_repeated_share"] = repeated_share;
}

/// All results of check for a film.
struct SceneCheck {
    struct OfSide {
        std::optional<Forecast> forecast;  // if it takes little time
        std::vector<std::string> alternatives;
    };
    const Scene& scene;
    SimulationEstimate simulation;
    std::optional<Needs> render;
    std::string why_not;           // if `render` is unknown
    std::map<char, OfSide> sides;  // by letter
};

SceneCheck checked(const Scene& scene, const std::atomic<bool>& stop) {
    check_encoder(video_options(scene));
    reset_peak_memory();
    SceneCheck check{scene, estimated_simulation(scene, stop), {}, {}, {}};
    try {
        check.render = estimated_render(scene, check.simulation, stop);
    } catch (const Error& error) {
        if (error.code() == ExitCode::interrupted) throw;
        check.why_not = error.what();
    }
    constexpr double patience = 2, longest = 6;  // s: runs that only give information; finding what they give
    const auto letters = scene.letters();
    for (const char letter : letters)
        if (check.sides[letter]; scene.side(letter).choice)
            check.sides[letter].alternatives = alternatives_of(scene, letter, stop);
    if (check.simulation.at_least || check.simulation.seconds >= patience) return check;
    const TimeLimit limit(longest, stop);
    parallel_for(letters.size(), cores(), [&](std::size_t i) {
        const auto& side = scene.side(letters[i]);
        if (side.replay) return;
        try {
            check.sides.at(letters[i]).forecast = forecast_of(scene, side, limit.reached());
        } catch (const Error& error) {
            throw_if_set(stop);
            if (error.code() != ExitCode::interrupted) throw;  // otherwise unknown: it takes too long
        }
    });
    return check;
}

void print(const SceneCheck& check) {
    const auto& scene = check.scene;
    const auto& estimate = check.simulation;
    const auto& video = scene.preset.video;
    print_line("{}: {}", scene.preset.name, scene.preset.title);
    for (const char letter : scene.letters()) {
        const auto& side = scene.side(letter);
        const auto& [forecast, alternatives] = check.sides.at(letter);
        print_side(letter, side);
        if (forecast) print_forecast(scene, side, *forecast);
        for (const auto& alternative : alternatives) print_line("         {}", alternative);
    }
    if (const auto words = no_difference(scene)) print_line("  pair   {}", *words);
    if (scene.certificate)
        for (const auto& sentence : certificate_words(scene, *scene.certificate)) print_line("  proof  {}", sentence);
    const bool adaptive = scene.a.method.adaptive || scene.b.method.adaptive;
    print_line("  time   {} s: samples 0 to {} at {} Hz, {}{} steps in all", scene.preset.duration_s.value(),
               scene.samples, scene.preset.sample_hz.text(),
               !adaptive           ? ""
               : estimate.at_least ? "more than "
                                   : "about ",
               counted(estimate.steps));
    const auto& every = scene.frames.stride;  // samples per frame
    const bool is_of_samples = every.is_whole() && every.numerator > 1;
    const auto stride = is_of_samples ? fmt::format(" (one in {} samples)", every.numerator) : "";
    print_line("  video  {} frames of {}×{} at {} frames/s{}, {}", grouped(schedule_of(scene).frames()),
               video.size.width, video.size.height, fmt::format("{:.6g}", scene.fps.value()), stride,
               format_words(scene));
    print_line("  takes  {} {} to simulate, {}", estimate.at_least ? "more than" : "about",
               duration_text(estimate.seconds),
               check.render ? duration_text(check.render->seconds) + " to render"
                            : "time to render unknown: " + check.why_not);
    if (check.render) print_needs(*check.render);
}

Json forecast_json(const Side& side, const Forecast& seen) {
    Json json{{"error", seen.error}, {"unit", side.has_angles ? "rad" : "its size"}, {"at_s", seen.error_s}};
    json["off_from_s"] = seen.is_off() ? Json(seen.error_s) : Json(nullptr);
    if (const auto& exponent = seen.exponent) {
        json["motion"] = seen.kind == Forecast::Kind::regular   ? "regular"
                         : seen.kind == Forecast::Kind::chaotic ? "chaotic"
                                                                : "unstable";
        json["exponent_per_s"] = {
            {"value", exponent->value}, {"uncertainty", exponent->uncertainty}, {"settled", exponent->is_settled}};
    }
    json["limit_s"] = seen.limit ? Json({seen.limit->from, seen.limit->to}) : Json(nullptr);
    return json;
}

/// The JSON of one side; adds its warnings to `warnings`.
Json side_json(const SceneCheck& check, char letter, Json& warnings) {
    const auto& scene = check.scene;
    const auto& side = scene.side(letter);
    const auto& track = letter == 'a' ? scene.preset.a.track : scene.preset.b.track;
    if (side.replay) return {{"model", "track"}, {"why", side.why}, {"file", track.file}};
    auto json = method_json(scene, side);
    json["precision"] = side.motion.precision == Precision::in_quad ? "quad" : "double";
    const auto& [forecast, alternatives] = check.sides.at(letter);
    const auto warn = [&](const std::string& words) { warnings.push_back(fmt::format("side {}: {}", letter, words)); };
    json["forecast"] = forecast ? forecast_json(side, *forecast) : Json(nullptr);
    if (forecast && !side.choice && forecast->is_off()) warn(error_words(side, forecast->error_s));
    if (forecast && forecast->exponent && forecast->kind == Forecast::Kind::chaotic && !forecast->exponent->is_settled)
        warn(unsettled_words);
    if (side.choice) json["other_accuracies"] = alternatives;
    return json;
}

/// The part common to films and figures.
Json heading_json(const PresetText& preset, const std::string& title) {
    std::error_code ignored;
    const bool is_file = std::filesystem::exists(preset.path, ignored);
    return {{"name", preset.name},
            {"title", title},
            {"kind", kind_of_preset(preset)},
            {"path", is_file ? Json(preset.path) : Json(nullptr)}};
}

Json json_of(const PresetText& preset, const SceneCheck& check, Json warnings) {
    const auto& scene = check.scene;
    const auto& video = scene.preset.video;
    const bool is_exact = !scene.a.method.adaptive && !scene.b.method.adaptive;
    auto json = heading_json(preset, scene.preset.title);
    for (const char letter : scene.letters()) json[std::string(1, letter)] = side_json(check, letter, warnings);
    if (const auto words = no_difference(scene)) warnings.push_back(*words);
    json["duration_s"] = scene.preset.duration_s.value();
    json["sample_hz"] = scene.preset.sample_hz.value();
    json["samples"] = scene.samples + 1;
    json["steps"] = check.simulation.steps;
    json["steps_are_exact"] = is_exact;
    json["frames"] = schedule_of(scene).frames();
    json["fps"] = scene.fps.value();
    json["size"] = {video.size.width, video.size.height};
    json["format"] = name_of(video.format);
    json["encoding"] = format_words(scene);
    json["simulate_s"] = check.simulation.seconds;
    json["render_s"] = check.render ? Json(check.render->seconds) : Json(nullptr);
    json["times_are_least"] = check.simulation.at_least;
    add_needs(json, check.render);
    if (scene.certificate) json["certificate"] = certificate_json(scene, *scene.certificate);
    json["horizon_s"] = scene.horizon() ? Json(*scene.horizon()) : Json(nullptr);
    json["warnings"] = std::move(warnings);
    return json;
}

struct FigureCheck {
    const FigurePreset& figure;
    double units = 0;
    int threads = 1;
    Needs estimate;
};

FigureCheck checked(const FigurePreset& figure, const std::atomic<bool>& stop) {
    FigureCheck check{figure, 0, figure.experiment->measures_time() ? 1 : cores(), {}};
    reset_peak_memory();
    for (std::size_t trial = 0; trial < figure.experiment->trials(); ++trial)
        check.units += figure.experiment->units(trial);
    check.estimate = estimated_computation(figure, check.threads, stop);
    return check;
}

void print(const FigureCheck& check) {
    const auto& [figure, units, threads, estimate] = check;
    const auto layout = layout_of(figure.chart);
    constexpr double cm_per_pt = 2.54 / 72;
    print_line("{}: {}", figure.name, figure.title);
    const auto trials = static_cast<long>(figure.experiment->trials());
    print_line("  kind   {}: {} trial{}; {}: {}", figure.kind, grouped(trials), trials == 1 ? "" : "s",
               figure.experiment->unit(), grouped(std::lround(units)));
    const auto format = name_of(figure.chart.format);
    if (figure.chart.width_cm || figure.chart.format != PictureFormat::png)
        print_line("  chart  {:.3g}×{:.3g} cm, {}, {}", cm_per_pt * layout.width_pt,
                   cm_per_pt * layout.width_pt * layout.picture.height / layout.picture.width, format,
                   figure.chart.theme);
    else
        print_line("  chart  {}×{} px, {}", layout.picture.width, layout.picture.height, figure.chart.theme);
    print_line("  takes  {} {} on {} thread{}, {} {}/s", estimate.at_least ? "more than" : "about",
               duration_text(estimate.seconds), threads, threads == 1 ? "" : "s", two_digits(units / estimate.seconds),
               figure.experiment->unit());
    print_needs(estimate);
}

Json json_of(const PresetText& preset, const FigureCheck& check, Json warnings) {
    const auto& [figure, units, threads, estimate] = check;
    const auto layout = layout_of(figure.chart);
    auto json = heading_json(preset, figure.title);
    json["trials"] = figure.experiment->trials();
    json["units"] = units;
    json["unit"] = figure.experiment->unit();
    json["size"] = {layout.picture.width, layout.picture.height};
    json["width_pt"] = layout.width_pt;
    json["format"] = name_of(figure.chart.format);
    json["theme"] = figure.chart.theme;
    json["threads"] = threads;
    json["compute_s"] = estimate.seconds;
    json["times_are_least"] = estimate.at_least;
    add_needs(json, estimate);
    json["warnings"] = std::move(warnings);
    return json;
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
        auto warnings = Json::array();
        if (const auto error = schema_line_error(preset)) warnings.push_back(*error);
        if (!options.as_json)
            for (const auto& warning : warnings) print_line("{}", warning.get<std::string>());
        const auto report = [&](const auto& check) {
            if (options.as_json)
                all.push_back(json_of(preset, check, std::move(warnings)));
            else
                print(check);
        };
        const bool is_chart = is_figure(preset);
        const auto overrides = overrides_of(
            options, picture_overrides(is_chart ? "chart" : "video", options.size, options.format, options.quality));
        if (is_chart)
            report(checked(read_figure(preset, overrides, stop), stop));
        else
            report(checked(make_scene(read_preset(preset, overrides), stop), stop));
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
    add_value(command, "--format", options->format, "FORMAT", "Format, as render or figure takes it");
    add_quality_option(command, options->quality);
    command.add_flag("--json", options->as_json,
                     "The same as JSON, an array with an object a preset: see docs/files.md");
    command.callback([options] { check_presets(*options); });
}

}  // namespace doppel

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/options.hpp"
#include "figure/computation.hpp"
#include "film/schedule.hpp"
#include "numeric/share_out.hpp"
#include "scene/choice.hpp"
#include "scene/outlook.hpp"
#include "scene/wording.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <memory>

namespace doppel {
namespace {

long frames_of(const Scene& scene) {
    return schedule_of(scene).frames();
}

/// "H.264 veryfast, crf 18", "PNG sequence", "GIF".
std::string format_words(const VideoSpec& video) {
    if (video.format == "png") return "PNG sequence";
    if (video.format == "gif") return "GIF";
    if (video.format == "apng") return "animated PNG";
    const auto codec = video.format == "mp4" ? "H.264" : video.codec == "av1" ? "AV1" : "VP9";
    return fmt::format("{} {}, crf {}, {}", codec, video.preset, video.crf, video.pixel_format);
}

/// What a look at the first samples tells of the whole run.
struct Estimate {
    double seconds = 0;  // to simulate
    long steps_a = 0, steps_b = 0;
};

Estimate estimated_simulation(const Scene& scene) {
    using Clock = std::chrono::steady_clock;
    PairRun pair(scene);
    const std::atomic<bool> never = false;
    pair.next(never);
    const auto start = Clock::now();
    long samples = 0;
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    while (samples < scene.samples && elapsed() < 0.05) {
        pair.next(never);
        ++samples;
    }
    if (samples == 0) return {};
    const double share = static_cast<double>(scene.samples) / static_cast<double>(samples);
    const auto whole = [&](const Effort& effort) { return std::lround(static_cast<double>(effort.steps) * share); };
    return {elapsed() * share, whole(pair.effort_a()), whole(pair.effort_b())};
}

/// Drawing and encoding, s; measured on two cores, in ms a megapixel.
double estimated_pictures(const Scene& scene) {
    const auto& video = scene.preset.video;
    const double megapixels = 1e-6 * video.size.width * video.size.height;
    const bool slow = video.preset.find("slow") != std::string::npos;
    const double ms = video.format == "png"         ? 3.5
                      : video.format == "webm"      ? 20
                      : video.format != "mp4"       ? 10
                      : video.preset == "ultrafast" ? 2
                      : video.preset == "medium"    ? 6
                      : slow                        ? 12
                                                    : 3.6;
    return 1e-3 * ms * megapixels * static_cast<double>(frames_of(scene));
}

void print_side(const char* name, const Side& side) {
    const auto steps = side.method.adaptive ? std::string("its own steps")
                                            : fmt::format("{} steps a sample", grouped(side.motion.steps_per_sample));
    fmt::print("  {}      {}, {}, {}, {}\n         {}: {}\n", name, name_of(side.motion.model), side.method.title,
               pace_words(side), steps, name_of(side.motion.model), side.why);
}

/// What to expect of a side: how far it errs, and how far any run of its precision could be right.
void print_outlook(const Scene& scene, const Side& side, const std::atomic<bool>& stop) {
    const auto seen = outlook(scene, side, stop);
    const auto unit = side.has_angles ? "rad" : "of its size";
    const auto say = [](const std::string& words) { fmt::print("         {}\n", words); };
    if (side.choice && side.choice->horizon < scene.samples)
        say(fmt::format("errs by less than {} {} up to {:.3g} s; beyond, rounding forbids it",
                        scientific(side.choice->accuracy), unit, scene.time(side.choice->horizon)));
    else if (side.choice)
        say(fmt::format("errs by {} {} at most, to the end; verified by {}", scientific(side.choice->estimated_error),
                        unit, side.choice->verified_by));
    else if (seen.error_s < scene.time(scene.samples))
        say(fmt::format("off by half {} from {:.3g} s on", side.has_angles ? "a rad" : "its size", seen.error_s));
    else
        say(fmt::format("errs by about {} {} at the end", scientific(seen.error), unit));
    if (seen.exponent && is_regular(*seen.exponent))
        say(fmt::format("regular: no Lyapunov exponent to be seen ({:.2g} ± {:.1g} 1/s)", seen.exponent->value,
                        seen.exponent->uncertainty));
    else if (seen.exponent)
        say(fmt::format("chaotic: errors grow tenfold every {:.2g} s (Lyapunov exponent {:.2g} ± {:.1g} 1/s)",
                        std::log(10) / seen.exponent->value, seen.exponent->value, seen.exponent->uncertainty));
    if (seen.horizon_s)
        say(fmt::format("beyond {:.2g} s no run in {} can be right", *seen.horizon_s,
                        side.motion.precision == Precision::in_quad ? "quad" : "double"));
}

/// What half or ten times the accuracy would take, against what is asked.
void print_rivals(const Scene& scene, const SideSpec& spec, const Side& side, const std::atomic<bool>& stop) {
    for (const auto& [factor, title] : {std::pair(Quad(2), "half"), {Quad(1) / 10, "ten times"}}) {
        auto other = spec;
        *other.accuracy *= factor;
        if (*other.accuracy > 1) continue;
        std::string words = "is out of reach";
        try {
            const auto way = choose_side(other, scene.preset.duration_s, scene.preset.sample_hz, stop);
            words = fmt::format("takes {:.2f} times the work ({}, {})",
                                way.choice->evaluations / side.choice->evaluations, way.method.name, pace_words(way));
            if (way.choice->horizon < scene.samples)
                words += fmt::format(", up to {:.3g} s", scene.time(way.choice->horizon));
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::bad_input) throw;
        }
        fmt::print("         {} the accuracy {}\n", title, words);
    }
}

void print_scene(const Scene& scene, const std::atomic<bool>& stop) {
    const auto& video = scene.preset.video;
    fmt::print("{}: {}\n", scene.preset.name, scene.preset.title);
    const auto estimate = estimated_simulation(scene);
    constexpr double patience = 2;  // s, for runs that only inform
    for (const auto* side : {&scene.a, &scene.b}) {
        const bool is_a = side == &scene.a;
        print_side(is_a ? "a" : "b", *side);
        if (estimate.seconds < patience) print_outlook(scene, *side, stop);
        if (side->choice) print_rivals(scene, is_a ? scene.preset.a : scene.preset.b, *side, stop);
    }
    const bool adaptive = scene.a.method.adaptive || scene.b.method.adaptive;
    fmt::print("  time   {} s: samples 0 to {} at {} Hz, {}{} steps in all\n", scene.preset.duration_s.value(),
               scene.samples, scene.preset.sample_hz.text(), adaptive ? "about " : "",
               grouped(estimate.steps_a + estimate.steps_b));
    fmt::print("  video  {} frames of {}×{} at {} frames/s, {}\n", grouped(frames_of(scene)), video.size.width,
               video.size.height, scene.fps.text(),
               format_words(video));
    const double pictures = estimated_pictures(scene);
    fmt::print("  takes  about {:.2g} s to simulate, {:.2g} s to render\n", estimate.seconds,
               std::max(estimate.seconds, pictures));
}

void print_figure(const FigurePreset& figure) {
    double units = 0;
    for (std::size_t trial = 0; trial < figure.work->trials(); ++trial) units += figure.work->units(trial);
    const auto size = figure.picture_size();
    fmt::print("{}: {}\n  kind   {}: {} {} in {} trials\n", figure.name, figure.title, figure.kind,
               grouped(std::lround(units)), figure.work->unit(), grouped(static_cast<long>(figure.work->trials())));
    fmt::print("  chart  {}×{} px, {}\n", size.width, size.height, figure.chart.theme);
    const int threads = figure.work->measures_time() ? 1 : cores();
    const auto estimate = estimated_computation(figure, threads);
    fmt::print("  takes  {} {:.2g} s on {} thread{}, {} {}/s\n", estimate.at_least ? "more than" : "about",
               estimate.seconds, threads, threads == 1 ? "" : "s", roughly(units / estimate.seconds),
               figure.work->unit());
}

}  // namespace

void add_check(CLI::App& app) {
    auto options = std::make_shared<PresetOptions>();
    auto& command = *app.add_subcommand("check", "What a preset would run: models and why, errors, steps, time");
    command.footer(
        "Examples:\n"
        "  doppel check butterfly\n"
        "  doppel check butterfly --set system.accuracy=1e-6    the cheapest way to that error, in rad, and how far it "
        "holds\n"
        "  doppel check flip-map                                what a figure would take");
    add_preset_options(command, *options);
    command.callback([options] {
        const auto& stop = watch_interrupts();
        for (const auto& name : options->presets) {
            const auto preset = find_preset(name);
            if (is_figure(preset))
                print_figure(read_figure(preset, overrides_of(*options)));
            else
                print_scene(make_scene(read_preset(preset, overrides_of(*options)), stop), stop);
        }
    });
}

}  // namespace doppel

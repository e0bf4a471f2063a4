#include "base/machine.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "figure/computation.hpp"
#include "film/estimate.hpp"
#include "film/film.hpp"
#include "scene/captions.hpp"
#include "scene/forecast.hpp"
#include "scene/method_choice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

namespace doppel {
namespace {

long frames_of(const Scene& scene) {
    return schedule_of(scene).frames();
}

/// "H.264 veryfast, crf 18, yuv420p", "PNG sequence", "GIF".
std::string format_words(const VideoSpec& video) {
    const auto& row = video.format_row();
    if (!row.is_encoded()) return std::string(row.title);
    return fmt::format("{} {}, crf {}, {}", row.title, video.preset, video.crf, name_of(video.pixel_format));
}

/// "1 800 000", whatever the number.
std::string counted(double number) {
    constexpr double most = 1e18;
    return number < most ? grouped(std::llround(number)) : scientific(number);
}

void print_side(const char* name, const Side& side) {
    if (side.replay) return print_line("  {}      {}", name, side.why);
    const auto steps = side.method.adaptive ? std::string("its own steps")
                                            : fmt::format("{} steps a sample", grouped(side.motion.steps_per_sample));
    print_line("  {}      {}, {}, {}, {}", name, name_of(side.motion.model), side.method.title, step_control_text(side),
               steps);
    print_line("         {}: {}", name_of(side.motion.model), side.why);
}

/// What to expect of a side: how far it errs, and how far any run of its precision could be right.
void print_forecast(const Scene& scene, const Side& side, const std::atomic<bool>& stop) {
    const auto seen = forecast_of(scene, side, stop);
    const auto unit = side.has_angles ? "rad" : "of its size";
    const auto precision = side.motion.precision == Precision::in_quad ? "quad" : "double";
    const auto say = [](const std::string& words) { print_line("         {}", words); };
    if (side.choice && side.choice->horizon < scene.samples)
        say(fmt::format("errs by less than {} {} up to {:.3g} s; no setting holds much longer in {}",
                        scientific(side.choice->accuracy), unit, scene.time(side.choice->horizon), precision));
    else if (side.choice)
        say(fmt::format("errs by {} {} at most, to the end; verified by {}", scientific(side.choice->estimated_error),
                        unit, side.choice->reference->description()));
    else if (seen.error_s < scene.time(scene.samples))
        say(fmt::format("off by half {} from {:.3g} s on", side.has_angles ? "a rad" : "its size", seen.error_s));
    else
        say(fmt::format("errs by about {} {} at the end", scientific(seen.error), unit));
    if (seen.exponent) {
        const auto& [value, uncertainty, is_settled] = *seen.exponent;
        const double tenfold = std::log(10) / value;
        switch (seen.kind) {
            case Forecast::Kind::regular:
                say(fmt::format("regular: no Lyapunov exponent to be seen ({:.2g} ± {:.1g} 1/s)", value, uncertainty));
                break;
            case Forecast::Kind::chaotic:
                say(fmt::format("chaotic: errors grow tenfold every {:.2g} s (Lyapunov exponent {:.2g} ± {:.1g} 1/s)",
                                tenfold, value, uncertainty));
                if (!is_settled) say("stretches of the motion differ by more than chance: that ± may be too small");
                break;
            case Forecast::Kind::unstable:
                say(
                    fmt::format("released at an unstable equilibrium: near it errors grow tenfold every {:.2g} s "
                                "(exponent {:.2g} 1/s); this alone is no chaos",
                                tenfold, value));
        }
    }
    if (seen.limit) {
        const auto from = fmt::format("{:.2g}", seen.limit->from), to = fmt::format("{:.2g}", seen.limit->to);
        say(fmt::format("{} can follow it for about {}{} s", precision, from, from == to ? "" : " to " + to));
    }
}

/// What half or ten times the accuracy would take, against what is asked.
void print_rivals(const Scene& scene, Side Scene::*which, const std::atomic<bool>& stop) {
    const auto& choice = *(scene.*which).choice;
    for (const auto& [factor, title] : {std::pair(2.0, "half"), {0.1, "ten times"}}) {
        if (factor * choice.accuracy > 1) continue;
        std::string words = "is out of reach";
        try {
            const auto rivals = scene.chooser->choose(factor, stop);
            const auto& rival = *rivals[which == &Scene::a ? 0 : 1];
            // where rounding decides how far it holds, it decides the work too
            words = rival.choice->horizon < scene.samples
                        ? fmt::format("holds up to {:.3g} s", scene.time(rival.choice->horizon))
                        : fmt::format("takes {:.2f} times the work ({}, {})", rival.choice->work / choice.work,
                                      rival.method.name, step_control_text(rival));
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::bad_input) throw;
        }
        print_line("         {} the accuracy {}", title, words);
    }
}

/// "5.1 s to render", or why that is not known.
std::string render_words(const Scene& scene, const SimulationEstimate& simulation, const std::atomic<bool>& stop) {
    try {
        return fmt::format("{:.2g} s to render", estimated_render(scene, simulation, stop));
    } catch (const Error& fault) {
        if (fault.code() == ExitCode::interrupted) throw;
        return fmt::format("to render is not known: {}", fault.what());
    }
}

void print_scene(const Scene& scene, const std::atomic<bool>& stop) {
    const auto& video = scene.preset.video;
    print_line("{}: {}", scene.preset.name, scene.preset.title);
    check_video(video_options(scene));
    const auto estimate = estimated_simulation(scene, stop);
    constexpr double patience = 2;  // s, for runs that only inform
    for (const auto which : {&Scene::a, &Scene::b}) {
        const auto& side = scene.*which;
        print_side(which == &Scene::a ? "a" : "b", side);
        if (side.replay) continue;
        if (!estimate.at_least && estimate.seconds < patience) print_forecast(scene, side, stop);
        if (side.choice) print_rivals(scene, which, stop);
    }
    const bool adaptive = scene.a.method.adaptive || scene.b.method.adaptive;
    print_line("  time   {} s: samples 0 to {} at {} Hz, {}{} steps in all", scene.preset.duration_s.value(),
               scene.samples, scene.preset.sample_hz.text(),
               !adaptive           ? ""
               : estimate.at_least ? "more than "
                                   : "about ",
               counted(estimate.steps));
    const auto& every = scene.frames.stride;  // samples
    const bool is_of_samples = every.is_whole() && every.numerator > 1;
    const auto stride = is_of_samples ? fmt::format(" (one of {} samples is one)", every.numerator) : "";
    print_line("  video  {} frames of {}×{} at {} frames/s{}, {}", grouped(frames_of(scene)), video.size.width,
               video.size.height, fmt::format("{:.6g}", scene.fps.value()), stride, format_words(video));
    print_line("  takes  {} {:.2g} s to simulate, {}", estimate.at_least ? "more than" : "about", estimate.seconds,
               render_words(scene, estimate, stop));
}

void print_figure(const FigurePreset& figure, const std::atomic<bool>& stop) {
    double units = 0;
    for (std::size_t trial = 0; trial < figure.experiment->trials(); ++trial) units += figure.experiment->units(trial);
    const auto layout = layout_of(figure.chart);
    constexpr double cm_per_pt = 2.54 / 72;
    print_line("{}: {}", figure.name, figure.title);
    print_line("  kind   {}: {} {} in {} trials", figure.kind, grouped(std::lround(units)), figure.experiment->unit(),
               grouped(static_cast<long>(figure.experiment->trials())));
    const auto format = name_of(figure.chart.format);
    if (figure.chart.width_cm || figure.chart.format != PictureFormat::png)
        print_line("  chart  {:.3g}×{:.3g} cm, {}, {}", cm_per_pt * layout.width_pt,
                   cm_per_pt * layout.width_pt * layout.picture.height / layout.picture.width, format,
                   figure.chart.theme);
    else
        print_line("  chart  {}×{} px, {}", layout.picture.width, layout.picture.height, figure.chart.theme);
    const int threads = figure.experiment->measures_time() ? 1 : cores();
    const auto estimate = estimated_computation(figure, threads, stop);
    print_line("  takes  {} {:.2g} s on {} thread{}, {} {}/s", estimate.at_least ? "more than" : "about",
               estimate.seconds, threads, threads == 1 ? "" : "s", roughly(units / estimate.seconds),
               figure.experiment->unit());
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
            const auto preset = find_preset(name, &stop);
            if (const auto fault = schema_line_fault(preset)) print_line("{}", *fault);
            if (is_figure(preset))
                print_figure(read_figure(preset, overrides_of(*options), {}, stop), stop);
            else
                print_scene(make_scene(read_preset(preset, overrides_of(*options)), stop), stop);
        }
    });
}

}  // namespace doppel

#include "base/clock.hpp"
#include "base/error.hpp"
#include "film/film.hpp"
#include "film/run.hpp"
#include "output/png.hpp"
#include "output/transaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// "14", "6.8": up to microseconds, without zeros at the end.
std::string seconds_text(double seconds) {
    auto text = fmt::format("{:.6f}", seconds);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

}  // namespace

long still_sample(const Scene& scene, const Rational& time) {
    const auto &name = scene.preset.name, duration = scene.preset.duration_s.text();
    if (time.value() > scene.preset.duration_s.value())
        throw bad_input("--at {}: {} ends at {} s", time.text(), name, duration);
    const auto sample = product(time, scene.preset.sample_hz);
    if (sample && sample->is_whole()) return sample->numerator;
    const long before = std::lround(std::floor(time.value() * scene.preset.sample_hz.value()));
    throw bad_input("--at {}: {} has no sample there; those at {} s and {} s are next to it",
                    seconds_text(time.value()), name, seconds_text(scene.time(before)),
                    seconds_text(scene.time(before + 1)));
}

RunResult draw_still(const Scene& scene, const Rational& time, const RunOptions& options, const std::atomic<bool>& stop,
                     const std::function<void(const Progress&)>& report) {
    const double start = seconds_of(CLOCK_MONOTONIC);
    const long last = still_sample(scene, time);
    const auto text = seconds_text(scene.time(last));
    const auto name = fmt::format("{}.{}s.png", scene.preset.name, text);
    Transaction parts(options.out / scene.preset.name, "still");
    const auto place = parts.file(name);
    Composer composer(scene, stop);
    Canvas canvas(scene, composer, options.gl, stop);  // what cannot draw says so at once
    Simulation simulation(scene, last + 1, true, stop);
    const long end = last * scene.frames.ticks_per_sample;
    for (long tick = -1; tick < end;) {
        const auto snapshot = simulation.next();
        throw_if_set(stop);
        check_distance(scene, snapshot.pair);
        composer.add(snapshot);
        tick = snapshot.pair.tick;
        report({snapshot.pair.sample + 1, last + 1});
    }
    write_png(
        place, canvas.draw(composer.frame()),
        {.with_alpha = scene.preset.video.transparent,
         .metadata = metadata_of(scene.preset, fmt::format("at {} s of {}", text, scene.preset.duration_s.text()))},
        stop);
    parts.finished(name);
    auto files = parts.keeping_finished([&] {
        throw_if_set(stop);
        return parts.publish();
    });
    return {.files = std::move(files), .frames = 1, .samples = last + 1, .wall_s = seconds_of(CLOCK_MONOTONIC) - start};
}

}  // namespace doppel

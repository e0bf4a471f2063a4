// Which samples are frames.
#include "integrate/methods.hpp"
#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The rate of a GIF that names none, at which the last sample is a frame: the most frames a second up to 30, from 10
/// on or of all samples; where there is none, the fewest up to 50, which is what GIF can time. A film shorter than a
/// frame keeps all samples.
Rational usual_gif_rate(const Rational& sampled, const Preset& preset, long samples, const TomlReader& video) {
    constexpr double fewest = 10, usual = 30, most = 50;
    std::optional<Rational> faster;
    for (long stride = 1; stride <= samples; ++stride) {
        const auto rate = samples % stride == 0 ? quotient(sampled, {stride, 1}) : std::nullopt;
        if (!rate || rate->value() > most) continue;
        if (rate->value() <= usual && (stride == 1 || rate->value() >= fewest)) return *rate;
        if (rate->value() < fewest) break;
        faster = rate;
    }
    if (faster) return *faster;
    if (sampled.value() > most * static_cast<double>(samples)) return sampled;
    const long stride = std::lround(std::ceil(sampled.value() / usual));
    const auto shorter = quotient({std::max(samples - samples % stride, stride), 1}, preset.sample_hz);
    throw video.fault("fps",
                      "of a GIF must let the last of {} samples be a frame, and no rate from {} to {} does; "
                      "scene.duration_s = \"{}\" would do",
                      samples, fewest, most, shorter ? shorter->text() : "?");
}

/// The usual rates of films at which frames fall on samples and the last sample is one, for errors: "24, 30 or 60 do".
std::string rates_that_do(const Rational& sampled, long samples) {
    std::vector<std::string> rates;
    for (const long rate : {24, 25, 30, 48, 50, 60, 100, 120, 144, 240})
        if (const auto stride = quotient(sampled, {rate, 1});
            stride && stride->is_whole() && samples % stride->numerator == 0)
            rates.push_back(fmt::format("{}", rate));
    if (rates.empty()) return sampled.text() + " does";
    const auto last = rates.back();
    rates.pop_back();
    return rates.empty() ? last + " does" : fmt::format("{} and {} do", fmt::join(rates, ", "), last);
}

/// The samples a second next above those of the preset, whose steps stay whole, that would allow `fps`: "; with
/// scene.sample_hz = 125 it does". Nothing where there is none.
std::string samples_that_do(const Preset& preset, const Rational& fps) {
    const auto least = quotient(fps, preset.video.speed);
    constexpr long most = 100;
    for (long n = 1; least && n <= most; ++n) {
        const auto hz = product(*least, {n, 1});
        if (!hz || hz->value() < preset.sample_hz.value()) continue;
        const auto samples = product(preset.duration_s, *hz);
        const auto has_whole_steps = [&](const SideSpec& side) {
            if (side.accuracy || find_method(side.integrator)->adaptive) return true;
            const auto rate = quotient({1, 1}, side.step());
            const auto steps = rate ? quotient(*rate, *hz) : std::nullopt;
            return steps && steps->is_whole();
        };
        if (!samples || !samples->is_whole() || samples->numerator % n != 0) continue;
        if (has_whole_steps(preset.a) && has_whole_steps(preset.b))
            return fmt::format("; with scene.sample_hz = {} it does", toml_ratio(*hz));
    }
    return "";
}

}  // namespace

void check_frames(Preset& preset, const TomlReader& video) {
    const long samples = product(preset.duration_s, preset.sample_hz)->numerator;  // check_clock() saw to it
    const auto sampled = product(preset.sample_hz, preset.video.speed);
    if (sampled && !preset.video.fps && preset.video.format == FilmFormat::gif)
        preset.video.fps = usual_gif_rate(*sampled, preset, samples, video);
    const auto fps = preset.video.fps ? preset.video.fps : sampled;
    constexpr double most_fps = 1000;
    constexpr long most_digits = 1'000'000;
    if (!fps || fps->value() > most_fps || fps->numerator > most_digits || fps->denominator > most_digits)
        throw video.fault("fps", "must be at most {} and a fraction of whole numbers up to {}; it is {}", most_fps,
                          most_digits, fps ? fps->text() : "beyond them");
    const auto stride = sampled ? quotient(*sampled, *fps) : std::nullopt;
    if (!stride || !stride->is_whole())
        throw video.fault("fps", "must divide sample_hz · speed = {}, so that each frame is a sample; it is {}; {}{}",
                          sampled ? sampled->text() : "?", preset.video.fps->text(),
                          sampled ? rates_that_do(*sampled, samples) : "smaller ones do",
                          samples_that_do(preset, *fps));
    if (samples % stride->numerator != 0)
        throw video.fault("fps", "must let the last of {} samples be a frame; with {} one sample in {} is one; {}",
                          samples, preset.video.fps->text(), stride->numerator, rates_that_do(*sampled, samples));
    if (!preset.video.poster_s) return;
    const auto poster = product(*preset.video.poster_s, preset.sample_hz);
    if (!poster || !poster->is_whole() || poster->numerator > samples || poster->numerator % stride->numerator != 0)
        throw video.fault("poster_s", "must be the time of a frame, a multiple of {} s up to {} s; it is {}",
                          quotient(*stride, preset.sample_hz).value_or(Rational{0, 1}).text(), preset.duration_s.text(),
                          preset.video.poster_s->text());
}

}  // namespace doppel

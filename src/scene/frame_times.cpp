#include "base/error.hpp"
#include "integrate/methods.hpp"
#include "scene/preset_fields.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

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
    const auto least = quotient(fps, preset.video.speed.constant);
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

constexpr double most_fps = 1000;

/// Times that rise, frames that are not too many.
void check_changes(Preset& preset, const TomlReader& video) {
    const auto& changes = preset.video.speed.changes;
    const double end = preset.duration_s.value();
    if (changes.front().at_s.numerator != 0)
        throw video.fault("speed", "must begin at 0 s; it begins at {} s", changes.front().at_s.value());
    for (std::size_t i = 1; i < changes.size(); ++i)
        if (changes[i].at_s.value() <= changes[i - 1].at_s.value() || changes[i].at_s.value() > end)
            throw video.fault("speed", "must change at times that rise, up to {} s; {} s comes after {} s", end,
                              changes[i].at_s.value(), changes[i - 1].at_s.value());
    if (!preset.video.fps)
        preset.video.fps = preset.video.format == FilmFormat::gif ? Rational{30, 1} : preset.sample_hz;
    const double fps = preset.video.fps->value();
    if (fps > most_fps) throw video.fault("fps", "must be at most {}; it is {}", most_fps, fps);
    constexpr double most_frames = 1e7;
    if (const double frames = film_time(preset.video, end) * fps; frames > most_frames)
        throw video.fault("speed", "makes a film of {:.3g} frames; the most are {}", frames, most_frames);
    if (preset.video.poster_s && preset.video.poster_s->value() > end)
        throw video.fault("poster_s", "must be up to {} s; it is {}", end, preset.video.poster_s->value());
}

/// How far a change of pace is at the share u of its time: 3u² − 2u³, integrated from 0.
double eased(double u) {
    return u * u * u * (1 - u / 2);
}

/// How long before its time a change begins, s.
double ease_before(const VideoSpec& video, std::size_t change) {
    const auto& changes = video.speed.changes;
    return std::min(video.speed_ease_s, changes[change].at_s.value() - changes[change - 1].at_s.value());
}

/// What a film that needs `ticks` a sample may change whose steps give `have`; `per_tick` = its largest fps · s a tick.
std::string finer_steps(const Preset& preset, long have, double ticks, double per_tick) {
    const double times = std::ceil(ticks / static_cast<double>(have));
    const auto rate = product(preset.sample_hz, {have * std::lround(std::min(times, 1e6)), 1});
    const auto step = rate ? quotient({1, 1}, *rate) : std::nullopt;
    const bool chosen = preset.a.accuracy || preset.b.accuracy;
    const auto finer = chosen || !step ? "a smaller accuracy" : fmt::format("step_s = \"{}\"", step->text());
    const double fps = std::floor(static_cast<double>(have) * preset.sample_hz.value() * per_tick);
    return fps < 1 ? finer : fmt::format("{}, or fps up to {:g},", finer, fps);
}

/// The ticks of a sample: fine enough that rounding to them moves no frame by more than 1/64 of its way to the next, and
/// such that frames at each speed fall on them, where the steps can be divided so.
long ticks_of_sample(const Preset& preset, const Rational& fps, long common_steps) {
    const auto& changes = preset.video.speed.changes;
    const auto slowest = std::ranges::min_element(changes, {}, [](const auto& c) { return c.speed.value(); })->speed;
    // ticks from frame to frame at the slowest, for one tick a sample
    const double least = preset.sample_hz.value() * slowest.value() / fps.value();
    const auto fall_on_ticks = [&](long ticks) {
        return std::ranges::all_of(changes, [&](const auto& change) {
            const auto a_second = product(*product(preset.sample_hz, {ticks, 1}), change.speed);
            const auto stride = a_second ? quotient(*a_second, fps) : std::nullopt;
            return stride && stride->is_whole();
        });
    };
    constexpr long most = 100'000;
    constexpr double fine = 32, coarse = 8;
    long finest = 1, enough = 0;
    for (long ticks = 1; ticks <= (common_steps > 0 ? std::min(common_steps, most) : most); ++ticks) {
        if (common_steps % ticks != 0) continue;
        finest = ticks;
        if (static_cast<double>(ticks) * least < fine) continue;
        if (fall_on_ticks(ticks)) return ticks;
        if (enough == 0) enough = ticks;
        if (static_cast<double>(ticks) * least > 8 * fine) break;
    }
    if (enough > 0) return enough;
    if (static_cast<double>(finest) * least >= coarse) return finest;
    throw bad_input(
        "{}: [video] speed {} at {} frames/s needs moments that are {:.3g} s apart; a step is {:.3g} s: {} would do",
        preset.name, slowest.value(), fps.value(), slowest.value() / fps.value() / coarse,
        1 / (preset.sample_hz.value() * static_cast<double>(finest)),
        finer_steps(preset, finest, coarse / least, slowest.value() / coarse));
}

}  // namespace

long FrameTimes::first_from(long tick) const {
    if (ticks.empty()) return std::min((tick + stride - 1) / stride, count());
    return std::lower_bound(ticks.begin(), ticks.end(), tick) - ticks.begin();
}

long FrameTimes::next_moment(long tick) const {
    const long sample = (tick / ticks_per_sample + 1) * ticks_per_sample;
    if (ticks.empty()) return sample;
    const long frame = first_from(tick + 1);
    return frame < count() ? std::min(sample, this->tick(frame)) : sample;
}

double film_time(const VideoSpec& video, double time) {
    const auto& changes = video.speed.changes;
    double sum = 0, pace = 1 / changes.front().speed.value(), done = 0;  // up to `done`, s
    for (std::size_t i = 1; i < changes.size() && done < time; ++i) {
        const double next = 1 / changes[i].speed.value(), at = changes[i].at_s.value(), ease = ease_before(video, i);
        sum += pace * (std::min(time, at) - done);
        if (const double since = time - (at - ease); ease > 0 && since > 0)
            sum += (next - pace) * ease * eased(std::min(since / ease, 1.0));
        done = at;
        pace = next;
    }
    return sum + pace * std::max(time - done, 0.0);
}

Rational speed_at(const VideoSpec& video, double time) {
    const auto& speed = video.speed;
    if (!speed.changes_over_time()) return speed.constant;
    std::size_t now = 0;
    for (std::size_t i = 1; i < speed.changes.size(); ++i)
        if (time >= speed.changes[i].at_s.value() - ease_before(video, i) / 2) now = i;
    return speed.changes[now].speed;
}

FrameTimes frame_times(const Preset& preset, const Rational& fps, long samples, long common_steps) {
    const auto& video = preset.video;
    FrameTimes frames{.last = samples};
    if (!video.speed.changes_over_time()) {
        frames.stride = quotient(*product(preset.sample_hz, video.speed.constant), fps)->numerator;
        return frames;
    }
    frames.ticks_per_sample = ticks_of_sample(preset, fps, common_steps);
    frames.last = samples * frames.ticks_per_sample;
    const double ticks_a_second = preset.sample_hz.value() * static_cast<double>(frames.ticks_per_sample);
    const auto shown_at = [&](long tick) { return film_time(video, static_cast<double>(tick) / ticks_a_second); };
    const long count = std::lround(std::ceil(shown_at(frames.last) * fps.value() - 1e-6)) + 1;
    for (long k = 0, tick = 0; k < count; ++k) {
        const double wanted = static_cast<double>(k) / fps.value();
        // the last tick that is shown no later than wanted, or the one after it
        long low = tick, high = frames.last;
        while (low < high) {
            const long middle = low + (high - low + 1) / 2;
            (shown_at(middle) <= wanted ? low : high) = shown_at(middle) <= wanted ? middle : middle - 1;
        }
        tick = low;
        if (tick < frames.last && shown_at(tick + 1) - wanted < wanted - shown_at(tick)) ++tick;
        frames.ticks.push_back(tick);
    }
    frames.ticks.back() = frames.last;
    return frames;
}

void check_frames(Preset& preset, const TomlReader& video) {
    if (preset.video.speed.changes_over_time()) return check_changes(preset, video);
    const long samples = product(preset.duration_s, preset.sample_hz)->numerator;  // check_clock() saw to it
    const auto sampled = product(preset.sample_hz, preset.video.speed.constant);
    if (sampled && !preset.video.fps && preset.video.format == FilmFormat::gif)
        preset.video.fps = usual_gif_rate(*sampled, preset, samples, video);
    const auto fps = preset.video.fps ? preset.video.fps : sampled;
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

#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The exact rate behind a rounded decimal: 23.976 is 24000/1001, 29.97 is 30000/1001.
Rational exact_rate(const Rational& fps) {
    for (const long whole : {24, 30, 48, 60, 120})
        for (const long digits : {100, 1000})
            if (reduced(std::lround(static_cast<double>(1000 * whole * digits) / 1001), digits) == fps)
                return *reduced(1000 * whole, 1001);
    return fps;
}

void check_changes(const Preset& preset, const TomlReader& video) {
    const auto& changes = preset.video.speed.changes;
    const double end = preset.duration_s.value();
    if (changes.front().at_s.numerator != 0)
        throw video.error("speed", "must begin at 0 s; it begins at {} s", changes.front().at_s.value());
    for (std::size_t i = 1; i < changes.size(); ++i)
        if (changes[i].at_s.value() <= changes[i - 1].at_s.value() || changes[i].at_s.value() > end)
            throw video.error("speed", "must have increasing times, up to {} s; {} s comes after {} s", end,
                              changes[i].at_s.value(), changes[i - 1].at_s.value());
}

/// The progress of a change of speed at the fraction u of its time: the integral of 3u² − 2u³.
double eased(double u) {
    return u * u * u * (1 - u / 2);
}

/// Duration of a change before its nominal time, s.
double ease_before(const VideoSpec& video, std::size_t change) {
    const auto& changes = video.speed.changes;
    return std::min(video.speed_ease_s, changes[change].at_s.value() - changes[change - 1].at_s.value());
}

/// The number of frames for so many frame intervals; the last frame shows the end.
long frames_in(double times) {
    constexpr double rounding = 1e-6;
    return std::lround(std::ceil(times - rounding)) + 1;
}

/// Throws the error that the frame rate must be as `words` say: of fps, or else of speed.
[[noreturn]] void refuse_rate(const VideoSpec& spec, const TomlReader& video, const std::string& words) {
    if (spec.fps) throw video.error("fps", "{}", words);
    throw video.error("speed", "times sample_hz, the frames a second without fps, {}; set fps", words);
}

}  // namespace

Moment moment_at(double samples) {
    constexpr double rounding = 1e-6;  // samples
    const double nearest = std::round(samples), whole = std::floor(samples);
    if (std::abs(samples - nearest) < rounding) return {static_cast<long>(nearest)};
    return {static_cast<long>(whole), samples - whole};
}

Moment FrameTimes::at(long frame) const {
    if (frame + 1 == count) return last;
    if (!changing.empty()) return changing[static_cast<std::size_t>(frame)];
    const long samples = frame * stride.numerator, rest = samples % stride.denominator;
    return {samples / stride.denominator, static_cast<double>(rest) / static_cast<double>(stride.denominator)};
}

long FrameTimes::first_from(const Moment& moment) const {
    long low = 0, high = count;
    while (low < high) {
        const long middle = low + (high - low) / 2;
        at(middle) < moment ? low = middle + 1 : high = middle;
    }
    return low;
}

double film_time(const VideoSpec& video, double time) {
    const auto& changes = video.speed.changes;
    double sum = 0, slowness = 1 / changes.front().speed.value(), done = 0;  // up to `done`, s
    for (std::size_t i = 1; i < changes.size() && done < time; ++i) {
        const double next = 1 / changes[i].speed.value(), at = changes[i].at_s.value(), ease = ease_before(video, i);
        sum += slowness * (std::min(time, at) - done);
        if (const double since = time - (at - ease); ease > 0 && since > 0)
            sum += (next - slowness) * ease * eased(std::min(since / ease, 1.0));
        done = at;
        slowness = next;
    }
    return sum + slowness * std::max(time - done, 0.0);
}

Rational speed_at(const VideoSpec& video, double time) {
    const auto& speed = video.speed;
    if (!speed.changes_over_time()) return speed.constant;
    std::size_t now = 0;
    for (std::size_t i = 1; i < speed.changes.size(); ++i)
        if (time >= speed.changes[i].at_s.value() - ease_before(video, i) / 2) now = i;
    return speed.changes[now].speed;
}

FrameTimes frame_times(const Preset& preset, const Rational& fps, long samples) {
    const auto& video = preset.video;
    FrameTimes frames{.last = {samples}};
    if (!video.speed.changes_over_time()) {
        frames.stride = *quotient(*product(preset.sample_hz, video.speed.constant), fps);  // checked by check_frames()
        frames.count = frames_in(static_cast<double>(samples) / frames.stride.value());
        return frames;
    }
    const double end = preset.duration_s.value();
    frames.count = frames_in(film_time(video, end) * fps.value());
    double time = 0;
    for (long k = 0; k + 1 < frames.count; ++k) {
        const double wanted = static_cast<double>(k) / fps.value();
        double high = end;  // bisected to the last digit
        for (double middle = (time + high) / 2; middle > time && middle < high; middle = (time + high) / 2)
            (film_time(video, middle) <= wanted ? time : high) = middle;
        frames.changing.push_back(moment_at(time * preset.sample_hz.value()));
    }
    return frames;
}

void check_frames(Preset& preset, const TomlReader& video) {
    auto& spec = preset.video;
    if (spec.speed.changes_over_time()) check_changes(preset, video);
    const auto sampled = product(preset.sample_hz, spec.speed.constant);  // samples per second of film
    if (spec.fps) spec.fps = exact_rate(*spec.fps);
    constexpr double usual_gif_fps = 30;  // upper limit; the rate is a fraction of `sampled`
    if (!spec.fps && sampled && spec.format == FilmFormat::gif)
        spec.fps = quotient(*sampled, {std::max(1L, std::lround(std::ceil(sampled->value() / usual_gif_fps))), 1});
    if (!spec.fps && spec.speed.changes_over_time()) spec.fps = preset.sample_hz;
    const auto fps = spec.fps ? spec.fps : sampled;
    constexpr double max_fps = 1000;
    constexpr long max_digits = 1'000'000;
    if (!fps || fps->value() > max_fps || fps->numerator > max_digits || fps->denominator > max_digits)
        refuse_rate(spec, video,
                    fmt::format("must be at most {} and a fraction of whole numbers up to {}; it is {}", max_fps,
                                max_digits, fps ? fps->text() : "beyond them"));
    const double end = preset.duration_s.value(), samples = end * preset.sample_hz.value();
    const double seconds = spec.speed.changes_over_time() ? film_time(spec, end) : end / spec.speed.constant.value();
    const double frames = seconds * fps->value(), max_frames = std::max(1e7, samples);
    if (frames > max_frames)
        throw video.error("speed", "makes a film of {:.3g} frames; at most {} are possible", frames, max_frames);
    const auto stride = sampled ? quotient(*sampled, *fps) : std::nullopt;
    if (!stride || static_cast<double>(stride->numerator) * (frames + 1) > 2e18)  // range of 64-bit integers
        throw video.error("speed", "and fps must have simpler ratios to scene.sample_hz; it is {}",
                          spec.speed.constant.text());
    if (spec.poster_s && spec.poster_s->value() > end)
        throw video.error("poster_s", "must be up to {} s; it is {}", end, spec.poster_s->value());
    if (const auto error = rate_error(spec.options(*fps))) refuse_rate(spec, video, error->words);
}

}  // namespace doppel

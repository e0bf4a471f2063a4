#include "integrate/methods.hpp"
#include "scene/preset_tables.hpp"
#include "scene/side_reader.hpp"
#include "scene/video_reader.hpp"

#include <cstdlib>

namespace doppel {
namespace {

/// The whole-number rates next to `rate` (rounded) that divide `steps_per_second`, for the error that has to name them.
std::string rates_that_divide(const Rational& steps_per_second, double rate) {
    const auto divides = [&](long n) {
        const auto ratio = n > 0 ? quotient(steps_per_second, {n, 1}) : std::nullopt;
        return ratio && ratio->is_whole();
    };
    const long start = std::lround(std::min(rate, 1e6));
    std::string text;
    for (long n = start; n > 0 && n > start - 10000; --n)
        if (divides(n)) {
            text = fmt::format("{}", n);
            break;
        }
    for (long n = start + 1; n < start + 10000; ++n)
        if (divides(n)) return text.empty() ? fmt::format("{} would", n) : fmt::format("{} or {} would", text, n);
    return text.empty() ? "a longer or shorter step_s would" : text + " would";
}

/// Frames must fall on samples exactly.
void check_frames(const Preset& preset, const TomlReader& video) {
    const auto samples = *product(preset.duration_s, preset.sample_hz);  // whole: check_clock() saw to it
    const auto sampled = product(preset.sample_hz, preset.video.speed);
    const auto fps = preset.video.fps ? preset.video.fps : sampled;
    constexpr double most_fps = 1000;
    constexpr long most_digits = 1'000'000;
    if (!fps || fps->value() > most_fps || fps->numerator > most_digits || fps->denominator > most_digits)
        throw video.fault("fps", "must be at most {} and a fraction of whole numbers up to {}; it is {}", most_fps,
                          most_digits, fps ? fps->text() : "beyond them");
    if (!preset.video.fps) return;
    const auto stride = sampled ? quotient(*sampled, *preset.video.fps) : std::nullopt;
    if (!stride || !stride->is_whole())
        throw video.fault("fps", "must divide sample_hz · speed = {}, so that each frame is a sample; it is {}",
                          sampled ? sampled->text() : "?", preset.video.fps->text());
    if (samples.numerator % stride->numerator != 0)
        throw video.fault("fps", "must let the last of {} samples be a frame; with {} one sample in {} is one",
                          samples.numerator, preset.video.fps->text(), stride->numerator);
}

}  // namespace

std::string read_kind(TomlReader& scene) {
    std::string kind(pair_kind);
    scene.read_choice("kind", kind, scene_kinds);
    return kind;
}

void read_clock(TomlReader& scene, Preset& preset) {
    scene.read_positive_ratio("duration_s", preset.duration_s);
    scene.read_positive_ratio("sample_hz", preset.sample_hz);
}

void read_sides(const TomlDocument& document, const std::vector<TomlReader*>& levels, Preset& preset) {
    for (auto* level : levels) {
        auto system = document.table(*level, "system");
        read_side(system, preset.a);
    }
    preset.b = preset.a;
    for (auto* level : levels) {
        auto a = document.table(*level, "a"), b = document.table(*level, "b");
        read_side(a, preset.a);
        read_side(b, preset.b);
        if (preset.a.links() != preset.b.links())
            throw b.fault("links",
                          "must be that of the other side, so that the two can be compared; they are {} and {}",
                          preset.a.links(), preset.b.links());
    }
}

void check_clock(const Preset& preset, const TomlReader& scene) {
    for (const auto* side : {&preset.a, &preset.b}) {
        if (side->accuracy || find_method(side->integrator)->adaptive) continue;
        const auto rate = quotient({1, 1}, side->step());
        const auto steps = rate ? quotient(*rate, preset.sample_hz) : std::nullopt;
        if (!steps || !steps->is_whole())
            throw scene.fault("sample_hz", "must divide the step rate, {} Hz on side {}; it is {}; {} do",
                              rate ? rate->text() : "?", side == &preset.a ? "a" : "b", preset.sample_hz.text(),
                              rate ? rates_that_divide(*rate, preset.sample_hz.value()) : "another");
    }
    const auto samples = product(preset.duration_s, preset.sample_hz);
    if (!samples || !samples->is_whole())
        throw scene.fault("duration_s", "must be a whole number of samples at {} Hz; {} s are {}",
                          preset.sample_hz.text(), preset.duration_s.text(), samples ? samples->text() : "too many");
    constexpr long most_samples = 100'000'000;
    if (samples->numerator > most_samples)
        throw scene.fault("duration_s", "must be at most {} samples; it is {}", most_samples, samples->numerator);
}

Preset read_preset(const PresetText& source, const std::vector<Override>& overrides) {
    const auto document = parse_document(source, overrides);
    Preset preset;
    preset.name = preset.title = source.name;
    TomlReader top(&document.root, "", document.path, document.texts);
    top.read_text("title", preset.title);

    auto scene = document.table(top, "scene");
    if (read_kind(scene) != pair_kind)
        throw bad_input("{}: this is a figure, not a film; draw it with: doppel figure {}", source.path, source.name);
    read_clock(scene, preset);
    scene.finish();
    read_sides(document, {&top}, preset);
    auto video = document.table(top, "video");
    read_video(video, preset.video);
    top.finish();
    check_clock(preset, scene);
    check_frames(preset, video);
    return preset;
}

bool is_figure(const PresetText& source) {
    const auto document = parse_document(source, {});
    TomlReader top(&document.root, "", document.path, document.texts);
    auto scene = document.table(top, "scene");
    return read_kind(scene) != pair_kind;
}

}  // namespace doppel

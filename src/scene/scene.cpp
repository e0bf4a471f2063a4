#include "scene/scene.hpp"

#include "analysis/distance.hpp"
#include "analysis/energy_error.hpp"
#include "numeric/error.hpp"
#include "scene/choice.hpp"
#include "scene/choose.hpp"
#include "scene/precision.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

double Scene::time(long sample) const {
    return static_cast<double>(sample) * static_cast<double>(preset.sample_hz.denominator) /
           static_cast<double>(preset.sample_hz.numerator);
}

std::optional<double> Scene::horizon() const {
    long first = samples;
    for (const auto* side : {&a, &b})
        if (side->choice) first = std::min(first, side->choice->horizon);
    if (first == samples) return std::nullopt;
    return time(first);
}

namespace {

/// Errors say whose they are.
Side side_of(const Preset& preset, const SideSpec& spec, char name, const std::atomic<bool>& stop) {
    try {
        if (spec.accuracy) return choose_side(spec, preset.duration_s, preset.sample_hz, stop);
        return make_side(spec, preset.sample_hz);
    } catch (const Error& fault) {
        throw Error(fault.code(), fmt::format("{}: side {}: {}", preset.name, name, fault.what()));
    }
}

}  // namespace

Scene make_scene(const Preset& preset, const std::atomic<bool>& stop) {
    Scene scene{.preset = preset,
                .a = side_of(preset, preset.a, 'a', stop),
                .b = side_of(preset, preset.b, 'b', stop),
                .samples = product(preset.duration_s, preset.sample_hz)->numerator,
                .fps = {},
                .samples_per_frame = 1};
    const auto samples_a_second = *product(preset.sample_hz, preset.video.speed);
    scene.fps = preset.video.fps.value_or(samples_a_second);
    scene.samples_per_frame = quotient(samples_a_second, scene.fps)->numerator;
    check_precision(scene);
    return scene;
}

std::string_view name_of(Model model) {
    return model == Model::angles ? "angles" : model == Model::constraints ? "constraints" : "mechanism";
}

Moment PairRun::next(const std::atomic<bool>& stop) {
    Moment now;
    now.sample = ++sample_;
    now.a = a_.next(stop);
    now.b = b_.next(stop);
    now.energy_error_a = a_.energy_error(now.a);
    now.energy_error_b = b_.energy_error(now.b);
    const bool exact = !now.a.exact.empty() && !now.b.exact.empty();
    now.distance = exact ? static_cast<double>(state_space_distance(now.a.exact, now.b.exact))
                         : state_space_distance(now.a.bobs, now.b.bobs);
    return now;
}

}  // namespace doppel

#include "scene/scene.hpp"

#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "scene/assemble.hpp"
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

/// The members of an ensemble, stepped as side a is.
std::vector<MotionSpec> crowd_of(const Scene& scene) {
    const auto &first = scene.preset.a, &last = scene.preset.b;
    std::vector<MotionSpec> crowd;
    for (int k = 0; k < scene.preset.video.members; ++k) {
        const Quad share = Quad(k) / (scene.preset.video.members - 1);
        const auto between = [&](const Quad& from, const Quad& to) { return Quad(from + share * (to - from)); };
        SideSpec member = first;
        for (const auto numbers :
             {&SideSpec::mass_kg, &SideSpec::length_m, &SideSpec::angle_deg, &SideSpec::omega_deg_per_s})
            std::transform((first.*numbers).begin(), (first.*numbers).end(), (last.*numbers).begin(),
                           (member.*numbers).begin(), between);
        member.gravity_m_per_s2 = between(first.gravity_m_per_s2, last.gravity_m_per_s2);
        crowd.push_back(scene.a.motion);
        crowd.back().chain = chain_of(member);
        crowd.back().wants_tension = false;
    }
    return crowd;
}

}  // namespace

Scene make_scene(const Preset& preset, const std::atomic<bool>& stop) {
    Scene scene{.preset = preset,
                .a = side_of(preset, preset.a, 'a', stop),
                .b = side_of(preset, preset.b, 'b', stop),
                .samples = product(preset.duration_s, preset.sample_hz)->numerator,
                .crowd = {},
                .fps = {},
                .samples_per_frame = 1};
    const auto samples_a_second = *product(preset.sample_hz, preset.video.speed);
    scene.fps = preset.video.fps.value_or(samples_a_second);
    scene.samples_per_frame = quotient(samples_a_second, scene.fps)->numerator;
    const auto wanted = [&](StripKind kind) {
        return std::find(preset.video.strips.begin(), preset.video.strips.end(), kind) != preset.video.strips.end();
    };
    scene.a.motion.wants_tension = scene.b.motion.wants_tension = wanted(StripKind::rod_force);
    check_precision(scene);
    if (preset.video.layout == Arrangement::ensemble) scene.crowd = crowd_of(scene);
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

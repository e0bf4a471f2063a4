#include "scene/scene.hpp"

#include "analysis/distance.hpp"
#include "analysis/energy_error.hpp"
#include "numeric/error.hpp"
#include "numeric/state.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

Side make_side(const SideSpec& spec, const Rational& sample_hz) {
    Side side;
    side.pendulum.mass = spec.mass_kg;
    side.pendulum.length = spec.length_m;
    side.pendulum.gravity = spec.gravity_m_per_s2;
    for (std::size_t i = 0; i < link_count; ++i) {
        side.pendulum.angle[i] = radians(spec.angle_deg[i]);
        side.pendulum.rate[i] = radians(spec.omega_deg_per_s[i]);
    }
    switch (spec.model) {
        case ModelChoice::automatic:
            side.model = Model::angles;
            side.why = "two links and no further forces: the closed form in angles is the smallest model that serves";
            break;
        case ModelChoice::angles:
            side.model = Model::angles;
            side.why = "the preset asks for it";
            break;
        case ModelChoice::constraints:
            side.model = Model::constraints;
            side.why = "the preset asks for it";
            break;
    }
    side.method =
        *std::find_if(methods.begin(), methods.end(), [&](const auto& m) { return m.name == spec.integrator; });
    side.step = spec.step_s;
    side.steps_per_sample = quotient(*quotient({1, 1}, spec.step_s), sample_hz)->numerator;
    return side;
}

bool finite(const Observation& seen) {
    const auto whole = [](const auto&... x) { return (std::isfinite(x) && ...); };
    return whole(seen.energy, seen.length_error) &&
           std::all_of(seen.bobs.begin(), seen.bobs.end(),
                       [&](const auto& bob) { return whole(bob.x, bob.y, bob.vx, bob.vy, bob.theta, bob.omega); });
}

}  // namespace

double Scene::time(long sample) const {
    return static_cast<double>(sample) * static_cast<double>(preset.sample_hz.denominator) /
           static_cast<double>(preset.sample_hz.numerator);
}

Scene make_scene(const Preset& preset) {
    Scene scene{.preset = preset,
                .a = make_side(preset.a, preset.sample_hz),
                .b = make_side(preset.b, preset.sample_hz),
                .samples = product(preset.duration_s, preset.sample_hz)->numerator,
                .fps = {},
                .samples_per_frame = 1};
    const auto samples_a_second = *product(preset.sample_hz, preset.video.speed);
    scene.fps = preset.video.fps.value_or(samples_a_second);
    scene.samples_per_frame = quotient(samples_a_second, scene.fps)->numerator;
    return scene;
}

std::string_view name_of(Model model) {
    return model == Model::angles ? "angles" : "constraints";
}

PairRun::PairRun(const Scene& scene) : scene_(scene), a_(runner(scene.a)), b_(runner(scene.b)) {}

PairRun::Runner PairRun::runner(const Side& side) {
    Runner made{side, make_motion(side.model, side.method.name, side.pendulum, side.step.value()), 0, 1};
    made.start_energy = made.motion->observe().energy;
    made.energy_scale = energy_scale(made.start_energy, side.pendulum);
    return made;
}

Observation PairRun::advanced(Runner& runner, std::string_view name, const std::atomic<bool>& stop) const {
    // in portions, so that an interruption is noticed in the middle of a long sample
    constexpr long portion = 200'000;
    for (long left = sample_ == 0 ? 0 : runner.side.steps_per_sample; left > 0; left -= portion) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        runner.motion->advance(std::min(left, portion));
    }
    auto seen = runner.motion->observe();
    if (!finite(seen))
        throw method_failed(
            "{}: side {} broke down: by t = {} s its state is no longer finite ({}, {}, step {} s); a smaller "
            "step_s or integrator = \"rk4\" may hold",
            scene_.preset.name, name, scene_.time(sample_), name_of(runner.side.model), runner.side.method.title,
            runner.side.step.text());
    return seen;
}

Moment PairRun::next(const std::atomic<bool>& stop) {
    if (stop) throw Error(ExitCode::interrupted, "interrupted");
    ++sample_;
    Moment now;
    now.sample = sample_;
    now.a = advanced(a_, "a", stop);
    now.b = advanced(b_, "b", stop);
    now.energy_error_a = (now.a.energy - a_.start_energy) / a_.energy_scale;
    now.energy_error_b = (now.b.energy - b_.start_energy) / b_.energy_scale;
    now.distance = state_space_distance(now.a.bobs, now.b.bobs);
    return now;
}

}  // namespace doppel

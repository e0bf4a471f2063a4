#include "figure/drift_run.hpp"

#include "base/clock.hpp"
#include "numeric/nan.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace doppel {
namespace {

constexpr double calibration_s = 200;
constexpr long looks_per_s = 4;  // at least, where steps are not longer

/// Settings are numbered, the finer the higher: steps of 100/n s, and tolerances of three digits from 0.0999 down to
/// four roundings.
constexpr long all_steps_s = 100;
constexpr long tolerances_a_decade = 900;
constexpr long finest_tolerance = 14 * tolerances_a_decade + 110;  // 8.89e-16

Quad tolerance_of(long n) {
    return parse_quad(fmt::format("{}e{}", 999 - n % tolerances_a_decade, -4 - n / tolerances_a_decade));
}

/// The method with its n-th setting, alone in a scene whose samples are the looks.
Scene scene_of(const DriftSpec& spec, const DriftMethod& method, long n) {
    auto side = spec.release;
    side.integrator = method.name;
    side.model = method.model == Model::angles ? ModelChoice::angles : ModelChoice::constraints;
    side.stabilise = method.projected ? Stabilise::projection : Stabilise::none;
    Scene scene{};
    if (find_method(method.name)->adaptive) {
        side.tolerance = tolerance_of(n);
        scene.preset.sample_hz = {looks_per_s, 1};
    } else {
        side.step_s = *reduced(all_steps_s, n);
        const long steps_a_look = std::max(1L, n / (all_steps_s * looks_per_s));
        scene.preset.sample_hz = *reduced(n, all_steps_s * steps_a_look);
    }
    scene.a = make_side(side, scene.preset.sample_hz);
    scene.a.motion.follows_turns = false;
    return scene;
}

/// Evaluations a second between the first look and the last, or the last before a breakdown; nothing where there are
/// not two.
std::optional<double> evaluation_rate(const Scene& scene, double duration_s, const std::atomic<bool>& stop) {
    SideRun run(scene, scene.a, 'a');
    long looks = 0, first = 0, last = 0;
    try {
        for (run.next(stop); scene.time(looks) < duration_s; ++looks) {
            run.next(stop);
            last = run.effort().evaluations;
            if (looks == 0) first = last;
        }
    } catch (const BreakDown&) {
        // a blow-up has cost what it has cost
    }
    if (looks < 2) return std::nullopt;
    return static_cast<double>(last - first) / scene.time(looks - 1);
}

/// The finest setting within the cost. One that breaks down at once is too coarse.
long calibrated(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop) {
    const double seconds = std::min(calibration_s, spec.times_s.back());
    const double most = spec.evaluations_per_s * (1 + 1e-9);
    const auto affordable = [&](long n) {
        return evaluation_rate(scene_of(spec, method, n), seconds, stop).value_or(0) <= most;
    };
    const bool adaptive = find_method(method.name)->adaptive;
    if (adaptive && affordable(finest_tolerance)) return finest_tolerance;
    long coarse = adaptive ? 0 : 1;
    long fine = adaptive ? finest_tolerance : static_cast<long>(all_steps_s * most) + 1;
    while (fine - coarse > 1) {
        const long middle = coarse + (fine - coarse) / 2;
        (affordable(middle) ? coarse : fine) = middle;
    }
    return coarse;
}

}  // namespace

DriftRun drift(const DriftSpec& spec, const DriftMethod& method, const std::atomic<bool>& stop) {
    const auto scene = scene_of(spec, method, calibrated(spec, method, stop));
    const auto& motion = scene.a.motion;
    const std::vector<double> unseen(spec.times_s.size(), nan_value);
    DriftRun made{.setting = scene.a.method.adaptive ? static_cast<double>(motion.tolerance) : scene.a.step.value(),
                  .broken_at_s = nan_value,
                  .energy_error = unseen,
                  .length_error = unseen};
    const auto lengths = motion.chain->cast<double>().length;
    const double shortest = *std::min_element(lengths.begin(), lengths.end());

    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    SideRun run(scene, scene.a, 'a');
    long look = 0;
    try {
        run.next(stop);
        for (std::size_t point = 0; point < unseen.size(); ++point)
            for (; scene.time(look + 1) <= spec.times_s[point]; ++look) {
                const auto seen = run.next(stop);
                const double energy = std::abs(run.energy_error(seen).value());
                if (energy >= 1 || seen.length_error >= shortest) throw BreakDown("the motion is lost", 'a', look + 1);
                made.energy_error[point] = std::fmax(made.energy_error[point], energy);
                made.length_error[point] = std::fmax(made.length_error[point], seen.length_error);
            }
    } catch (const BreakDown& fault) {
        look = fault.sample;
        made.broken_at_s = scene.time(look);
    }
    made.cpu_s = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
    made.evaluations_per_s = static_cast<double>(run.effort().evaluations) / scene.time(look);
    return made;
}

}  // namespace doppel

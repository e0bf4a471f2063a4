#include "analysis/stability.hpp"
#include "base/error.hpp"
#include "integrate/batch.hpp"
#include "physics/bob.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Takes the error of one sample in; NaN stays.
void take(double error, double& greatest) {
    if (error <= blow_up)
        greatest = std::max(error, greatest);
    else
        greatest = NAN;
}

double energy_of(const Pendulum<double>& p, const Batch& ensemble, std::size_t trial, Model model) {
    const auto y = ensemble.state(trial);
    return energy(model == Model::angles ? bobs_of_angles(p, y) : bobs_of_particles(p, y), p.gravity);
}

std::vector<double> side_by_side(const StabilityRun& run, std::span<const Pendulum<Quad>> releases,
                                 const std::atomic<bool>& stop) {
    std::vector<Pendulum<double>> pendulums;
    for (const auto& release : releases) pendulums.push_back(release.cast<double>());
    Batch ensemble(pendulums, run.model, run.method, run.step(), run.width);
    std::vector<double> start, scale, greatest(releases.size(), 0);
    for (std::size_t i = 0; i < pendulums.size(); ++i) {
        start.push_back(energy_of(pendulums[i], ensemble, i, run.model));
        scale.push_back(released_energy(pendulums[i]));
    }
    const auto is_over = [](double error) { return std::isnan(error); };
    for (long n = 0; n < run.samples && !std::all_of(greatest.begin(), greatest.end(), is_over); ++n) {
        throw_if_set(stop);
        ensemble.advance(run.steps_per_sample);
        for (std::size_t i = 0; i < pendulums.size(); ++i)
            if (!is_over(greatest[i]))
                take(std::abs(energy_of(pendulums[i], ensemble, i, run.model) - start[i]) / scale[i], greatest[i]);
    }
    return greatest;
}

double alone(const StabilityRun& run, const Pendulum<Quad>& release, const std::atomic<bool>& stop) {
    MotionSpec spec{.chain = release,
                    .parts = {},
                    .model = run.model,
                    .method = run.method,
                    .sample_interval = *quotient(run.duration, {run.samples, 1}),
                    .steps_per_sample = run.steps_per_sample,
                    .tolerance = run.tolerance,
                    .follows_turns = false};
    const double scale = released_energy(release.cast<double>());
    double greatest = 0;
    try {
        const auto motion = make_motion(spec);
        for (long n = 0; n < run.samples && !std::isnan(greatest); ++n) {
            motion->advance(stop);
            take(std::abs(motion->observe().energy_change) / scale, greatest);
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        return NAN;
    }
    return greatest;
}

}  // namespace

double released_energy(const Pendulum<double>& release) {
    // Σ ½ m v² + m g (l1 (1 − cosθ1) + l2 (1 − cosθ2) + …), without the cancellation of the levels
    double vx = 0, vy = 0, height = 0, sum = 0;
    for (std::size_t i = 0; i < release.links(); ++i) {
        const double l = release.length[i], theta = release.angle[i], half = SinCos<double>(theta / 2).sin;
        const SinCos<double> turn(theta);
        vx += l * release.rate[i] * turn.cos;
        vy += l * release.rate[i] * turn.sin;
        height += 2 * l * half * half;
        sum += release.mass[i] * ((vx * vx + vy * vy) / 2 + release.gravity * height);
    }
    return sum;
}

std::vector<double> greatest_energy_errors(const StabilityRun& run, std::span<const Pendulum<Quad>> releases,
                                           const std::atomic<bool>& stop) {
    if (!releases.empty() && Batch::serves(run.method, releases[0].links())) return side_by_side(run, releases, stop);
    std::vector<double> errors;
    for (const auto& release : releases) errors.push_back(alone(run, release, stop));
    return errors;
}

}  // namespace doppel

#include "figure/work_run.hpp"

#include "analysis/difference.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "numeric/nan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double long_enough_s = 1e-3;  // that a clock tells it within some tenths of a percent
constexpr double warm_enough_s = 3e-3;  // that what comes first is not seen
constexpr long most_runs = 32;          // at a time: all of them fit into the nearest cache

template <class Run>
double cpu_of(Run&& run) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    run();
    return seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

long runs_for(double cpu_s) {
    return std::clamp(static_cast<long>(std::ceil(long_enough_s / std::max(cpu_s, 1e-9))), 1L, most_runs);
}

MotionSpec spec_of(const WorkProblem& problem, const Contender& contender, const Setting& setting) {
    auto spec = problem.motion(contender.model);
    spec.method = contender.method;
    spec.steps_per_sample = setting.steps;
    spec.tolerance = setting.tolerance;
    return spec;
}

/// Worst energy and length errors, as seen some 240 times on the way.
void watch(const WorkProblem& problem, MotionSpec spec, Rung& rung, const std::atomic<bool>& stop) {
    constexpr long looks_wanted = 240;
    long looks = looks_wanted;
    if (const long steps = spec.steps_per_sample; steps > 0) {
        // the same steps, some of them between two looks
        spec.steps_per_sample = (steps + looks_wanted - 1) / looks_wanted;
        spec.sample_interval = *product(spec.sample_interval, *reduced(spec.steps_per_sample, steps));
        looks = steps / spec.steps_per_sample;
    } else {
        spec.sample_interval = *quotient(spec.sample_interval, {looks, 1});
    }
    const auto motion = make_motion(spec);
    const double scale = energy_scale(motion->observe().energy, problem.side.energy_unit);
    double energy = 0, length = 0;
    for (long i = 0; i < looks; ++i) {
        motion->advance(stop);
        const auto seen = motion->observe();
        energy = std::max(energy, std::abs(seen.energy_change) / scale);
        length = std::max(length, seen.length_error);
        if (!std::isfinite(seen.energy_change)) energy = length = std::numeric_limits<double>::infinity();
    }
    if (!std::isfinite(energy)) energy = length = nan_value;
    rung.energy_error = problem.conserves_energy ? energy : nan_value;
    rung.length_error = length;
}

/// Seconds of CPU for one advance of a motion of `spec`; `first_s` is what it took the first time.
double timed(const MotionSpec& spec, double first_s, const std::atomic<bool>& stop) {
    if (first_s > warm_enough_s) return first_s;
    std::vector<std::unique_ptr<Motion>> motions(static_cast<std::size_t>(runs_for(first_s)));
    for (auto& motion : motions) motion = make_motion(spec);
    const double all = cpu_of([&] {
        for (const auto& motion : motions) motion->advance(stop);
    });
    return all / static_cast<double>(motions.size());
}

}  // namespace

Rung motion_rung(const WorkProblem& problem, const Truth& truth, const Contender& contender, const Setting& setting,
                 const LadderSpec& spec, const std::atomic<bool>& stop) {
    Rung rung{setting.value, nan_value, nan_value, nan_value, nan_value, nan_value, nan_value};
    const auto motion_spec = spec_of(problem, contender, setting);
    const auto motion = make_motion(motion_spec);
    const auto take_effort = [&] {
        rung.evaluations = static_cast<double>(motion->effort().evaluations);
        rung.steps = static_cast<double>(motion->effort().steps);
    };
    try {
        const double first_s = cpu_of([&] { motion->advance(stop); });
        take_effort();
        rung.error = problem.error(motion->observe(), truth.reference);
        if (!std::isfinite(rung.error)) return rung;
        if (spec.watched) watch(problem, motion_spec, rung, stop);
        if (spec.timed) rung.cpu_s = timed(motion_spec, first_s, stop);
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::method_failed) throw;
        take_effort();
        rung.error = nan_value;
    }
    return rung;
}

Rung peer_rung(const WorkProblem& problem, const Truth& truth, const Peer& peer, const Setting& setting,
               const LadderSpec& spec) {
    Rung rung{setting.value, nan_value, nan_value, nan_value, nan_value, nan_value, nan_value};
    const auto& chain = *problem.side.motion.chain;
    try {
        const auto solver = peer.make(chain.cast<double>(), problem.duration.value(), setting.value);
        const double first_s = cpu_of([&] { solver->run(); });
        rung.evaluations = static_cast<double>(solver->evaluations());
        rung.steps = static_cast<double>(solver->steps());
        Observation seen;
        for (std::size_t i = 0; i < chain.links(); ++i) seen.bobs.push_back({.theta = solver->state()[i]});
        rung.error = problem.error(seen, truth.reference);
        if (!std::isfinite(rung.error)) rung.error = nan_value;
        if (!spec.timed) return rung;
        const long runs = runs_for(first_s);
        const double all = cpu_of([&] {
            for (long i = 0; i < runs; ++i) solver->run();
        });
        rung.cpu_s = first_s > warm_enough_s ? first_s : all / static_cast<double>(runs);
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::method_failed) throw;
    }
    return rung;
}

}  // namespace doppel

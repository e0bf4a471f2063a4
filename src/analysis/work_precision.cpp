#include "analysis/work_precision.hpp"

#include "analysis/watched_motion.hpp"
#include "base/machine.hpp"
#include "integrate/methods.hpp"

#include <algorithm>
#include <map>
#include <numbers>

namespace doppel {
namespace {

template <class Run>
double cpu_of(Run&& run) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    run();
    return seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

/// CPU time of one run of the motions that `make` returns, s; `first_s` is that of the first run.
template <class Make>
double timed(const Make& make, double first_s, const std::atomic<bool>& stop) {
    constexpr double long_enough_s = 1e-3;  // reduces the clock's error to some tenths of a percent
    constexpr double warm_enough_s = 3e-3;  // warms the caches
    constexpr long max_runs = 32;           // at a time: all of them fit into the first-level cache
    if (first_s > warm_enough_s) return first_s;
    const auto wanted = static_cast<long>(std::ceil(long_enough_s / std::max(first_s, 1e-9)));
    std::vector<std::unique_ptr<Motion>> motions(static_cast<std::size_t>(std::clamp(wanted, 1L, max_runs)));
    for (auto& motion : motions) motion = make();
    const double all = cpu_of([&] {
        for (const auto& motion : motions) motion->advance(stop);
    });
    return all / static_cast<double>(motions.size());
}

/// Finds the largest errors of energy and lengths at some 240 samples. Returns false if the run fails.
bool is_sound(const WorkProblem& problem, MotionSpec spec, StepResult& outcome, const std::atomic<bool>& stop) {
    long samples = 240;
    if (const long steps = spec.steps_per_sample; steps > 0) {
        // the same steps, except that some are between two samples
        spec.steps_per_sample = (steps + samples - 1) / samples;
        spec.sample_interval = *product(spec.sample_interval, *reduced(spec.steps_per_sample, steps));
        samples = steps / spec.steps_per_sample;
    } else {
        spec.sample_interval = *quotient(spec.sample_interval, {samples, 1});
    }
    WatchedMotion motion(spec, problem.energy_unit, problem.size);
    double energy = 0, length = 0;
    for (long i = 0; i < samples; ++i) {
        if (!motion.advance(stop)) return false;
        energy = std::max(energy, motion.energy_error);
        length = std::max(length, motion.length_error);
    }
    outcome.energy_error = problem.conserves_energy ? energy : NAN;
    outcome.length_error = length;
    return true;
}

StepResult run_setting(const WorkProblem& problem, const Reference& reference, const StepStudySpec& spec,
                       const MotionSpec& setting, const auto& make, const std::atomic<bool>& stop) {
    StepResult outcome{.setting = setting_of(setting)};
    const auto motion = make(setting);
    const ErrorScale proportion(motion->observe(), problem.energy_unit, problem.size);
    bool ends = false;
    const double first_s = cpu_of([&] { ends = advanced(*motion, stop); });
    outcome.evaluations = static_cast<double>(motion->effort().evaluations);
    outcome.steps = static_cast<double>(motion->effort().steps);
    if (!ends) return outcome;
    const auto end = motion->observe();
    if (!proportion.is_plausible(end) || (spec.watched && !is_sound(problem, setting, outcome, stop))) return outcome;
    const double error_of_end = ErrorMeasure{problem.has_angles(), problem.size}.distance(end, reference.end);
    if (!std::isfinite(error_of_end)) return outcome;
    outcome.error = error_of_end;
    if (spec.timed) outcome.cpu_s = timed([&] { return make(setting); }, first_s, stop);
    return outcome;
}

MotionSpec at_setting(const WorkProblem& problem, const Solver& solver, long steps, const Quad& tolerance) {
    auto motion = problem.motion;
    motion.model = solver.model;
    motion.method = solver.method;
    motion.steps_per_sample = steps;
    motion.tolerance = tolerance;
    return motion;
}

/// A quantile of sorted values, interpolated linearly.
double quantile(const std::vector<double>& sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const auto above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

}  // namespace

double setting_of(const MotionSpec& motion) {
    if (motion.steps_per_sample == 0) return static_cast<double>(motion.tolerance);
    return motion.sample_interval.value() / static_cast<double>(motion.steps_per_sample);
}

std::vector<MotionSpec> settings_of(const WorkProblem& problem, const Solver& solver, bool adaptive, long max_steps) {
    std::vector<MotionSpec> all;
    const auto add = [&](long steps, const Quad& tolerance) {
        all.push_back(at_setting(problem, solver, steps, tolerance));
    };
    constexpr int finest = 30;
    if (adaptive) {
        for (int k = 2; k <= finest; ++k) add(0, parse_quad(fmt::format("{}e-{}", k % 2 == 0 ? "1" : "0.316", k / 2)));
        return all;
    }
    const double kao_steps = problem.duration() / kao_step;
    for (int k = static_cast<int>(2 * std::log2(problem.natural_time / kao_step));; --k) {
        const double factor = std::ldexp(k % 2 == 0 ? 1 : std::numbers::sqrt2, -((k + (k % 2 != 0)) / 2));
        const long steps = std::max(1L, std::lround(kao_steps * factor));
        if (steps > max_steps && !all.empty()) return all;
        if (all.empty() || steps > all.back().steps_per_sample) add(steps, 0);
    }
}

std::vector<StepResult> run_settings(const WorkProblem& problem, const Reference& reference,
                                     std::span<const MotionSpec> settings, const StepStudySpec& spec,
                                     const std::atomic<bool>& stop,
                                     const std::function<std::unique_ptr<Motion>(const MotionSpec&)>& make) {
    double best = std::numeric_limits<double>::infinity();
    long since_best = 0;
    // finer settings do not help any more
    const auto is_at_floor = [&](double error) {
        constexpr double near = 100, useful = 1e-3;
        constexpr long patience = 3, long_patience = 8;
        since_best = error < best ? 0 : since_best + 1;
        best = std::fmin(best, error);
        return best < near * reference.floor() ? since_best >= patience : best < useful && since_best >= long_patience;
    };
    std::vector<StepResult> outcomes;
    for (const auto& setting : settings) {
        const auto& outcome = outcomes.emplace_back(run_setting(problem, reference, spec, setting, make, stop));
        const bool next_too_costly =
            std::numbers::sqrt2 * outcome.evaluations > static_cast<double>(spec.max_evaluations);
        if (next_too_costly || outcome.error < spec.min_error || is_at_floor(outcome.error)) break;
    }
    return outcomes;
}

std::vector<StepResult> run_step_study(const WorkProblem& problem, const Reference& reference, const Solver& solver,
                                       const StepStudySpec& spec, const std::atomic<bool>& stop) {
    const auto settings = settings_of(problem, solver, find_method(solver.method)->adaptive, spec.max_evaluations);
    auto outcomes = run_settings(problem, reference, settings, spec, stop);
    if (solver.is_kao_study() &&
        std::none_of(outcomes.begin(), outcomes.end(), [](auto& r) { return r.is_kao_study(); })) {
        const auto kao = at_setting(problem, solver, std::lround(problem.duration() / kao_step), 0);
        outcomes.push_back(run_setting(problem, reference, spec, kao, make_motion, stop));
    }
    return outcomes;
}

StepStudy merged(const Solver& solver, const std::vector<std::vector<StepResult>>& repeats) {
    StepStudy study{solver, repeats.front()};
    for (std::size_t i = 0; i < study.outcomes.size(); ++i) {
        auto& outcome = study.outcomes[i];
        std::vector<double> times;
        for (const auto& outcomes : repeats)
            if (i < outcomes.size() && std::isfinite(outcomes[i].cpu_s)) times.push_back(outcomes[i].cpu_s);
        if (times.empty() || outcome.failed()) continue;  // repeats do not check energies and lengths
        std::sort(times.begin(), times.end());
        outcome.cpu_s = quantile(times, 0.5);
        outcome.spread = (quantile(times, 0.75) - quantile(times, 0.25)) / 2 / outcome.cpu_s;
    }
    return study;
}

std::vector<StepResult> pareto_front(std::span<const StepStudy> studies, Cost cost, const ErrorRange& range) {
    std::vector<StepResult> points;
    for (const auto& [solver, outcomes] : studies)
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            const double error = outcomes[i].error;
            const bool is_lucky =
                i + 1 < outcomes.size() && error > range.minimum && !(outcomes[i + 1].error <= 2 * error);
            if (error <= range.maximum && outcomes[i].cost(cost) > 0 && !is_lucky) points.push_back(outcomes[i]);
        }
    std::stable_sort(points.begin(), points.end(), [&](const auto& a, const auto& b) {
        return std::pair(a.cost(cost), a.error) < std::pair(b.cost(cost), b.error);
    });
    std::vector<StepResult> front;
    for (const auto& point : points) {
        if (!front.empty() && front.back().error <= range.minimum) break;
        if (front.empty() || point.error < front.back().error) front.push_back(point);
    }
    return front;
}

Cheapest cheapest(std::span<const StepStudy> studies, Cost cost, double error, std::string_view method) {
    Cheapest best;
    for (const auto& study : studies) {
        const auto& outcomes = study.outcomes;
        if (!method.empty() && study.solver.method != method) continue;
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            const bool reaches =
                outcomes[i].error <= error && (i + 1 == outcomes.size() || outcomes[i + 1].error <= error);
            const double value = outcomes[i].cost(cost);
            if (reaches && value > 0 && value < best.cost) best = {&study, value};
        }
    }
    return best;
}

std::vector<const StepStudy*> best_models(std::span<const StepStudy> studies, Cost cost) {
    const auto wins = [&](const StepStudy& study) {
        constexpr int decades = 13;
        int count = 0;
        for (int decade = 1; decade <= decades; ++decade) {
            const double error = std::pow(10.0, -decade);
            const auto own = cheapest({&study, 1}, cost, error);
            count += own.study && own.cost == cheapest(studies, cost, error, study.solver.method).cost;
        }
        return count;
    };
    std::vector<const StepStudy*> best;
    for (const auto& study : studies)
        if (std::none_of(studies.begin(), studies.end(), [&](const StepStudy& other) {
                return other.solver.method == study.solver.method &&
                       std::pair(wins(other), &study) > std::pair(wins(study), &other);
            }))
            best.push_back(&study);
    return best;
}

std::vector<std::string> ranked(std::span<const std::vector<StepStudy>> problems, Cost cost,
                                std::span<const double> errors) {
    std::vector<std::string> names;
    for (const auto& studies : problems)
        for (const auto& [solver, outcomes] : studies)
            if (std::find(names.begin(), names.end(), solver.method) == names.end()) names.push_back(solver.method);
    std::map<std::string, long> ranks;
    for (const auto& studies : problems)
        for (const double error : errors) {
            std::vector<double> costs;
            for (const auto& name : names) costs.push_back(cheapest(studies, cost, error, name).cost);
            for (std::size_t i = 0; i < names.size(); ++i)
                ranks[names[i]] +=
                    std::count_if(costs.begin(), costs.end(), [&](double other) { return other < costs[i]; });
        }
    std::stable_sort(names.begin(), names.end(), [&](auto& one, auto& other) { return ranks[one] < ranks[other]; });
    return names;
}

std::pair<double, double> time_spread(std::span<const std::vector<StepStudy>> problems) {
    std::vector<double> spreads;
    for (const auto& studies : problems)
        for (const auto& study : studies)
            for (const auto& point : pareto_front({&study, 1}, Cost::time, {0, 1})) spreads.push_back(point.spread);
    if (spreads.empty()) return {NAN, NAN};
    std::sort(spreads.begin(), spreads.end());
    return {spreads[spreads.size() / 2], spreads.back()};
}

}  // namespace doppel

#include "analysis/work_ladder.hpp"

#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "base/clock.hpp"
#include "base/error.hpp"
#include "integrate/methods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace doppel {
namespace {

constexpr Rung no_rung{NAN, NAN, NAN, NAN, NAN, NAN, NAN};

struct Setting {
    double value;  // step, s, or tolerance
    long steps;    // of a fixed step; 0 for a tolerance
    Quad tolerance;
};

/// Steps of 2^(k/2)/30000 s, from the problem's natural time down.
std::vector<Setting> step_settings(const WorkProblem& problem, const LadderSpec& spec) {
    const double at_study = problem.duration() / study_step;
    std::vector<Setting> all;
    for (int k = static_cast<int>(2 * std::log2(problem.natural_time / study_step));; --k) {
        const double factor = std::ldexp(k % 2 == 0 ? 1 : std::numbers::sqrt2, -((k + (k % 2 != 0)) / 2));
        const long steps = std::max(1L, std::lround(at_study * factor));
        if (steps > spec.most_evaluations && !all.empty()) return all;
        if (all.empty() || steps > all.back().steps)
            all.push_back({problem.duration() / static_cast<double>(steps), steps, 0});
    }
}

/// 10^(−k/2), to three digits as they would be written, from a tenth to what double can give.
std::vector<Setting> tolerance_settings() {
    constexpr int last = 15;
    std::vector<Setting> all;
    for (int decade = 1; decade <= last; ++decade) {
        for (const auto* digits : {"1", "0.316"}) {
            const auto tolerance = parse_quad(fmt::format("{}e-{}", digits, decade));
            if (decade == last && all.size() % 2 == 1) break;
            all.push_back({static_cast<double>(tolerance), 0, tolerance});
        }
    }
    return all;
}

std::vector<Setting> settings(const WorkProblem& problem, const Solver& solver, const LadderSpec& spec) {
    auto all = solver.adaptive() ? tolerance_settings() : step_settings(problem, spec);
    if (const auto* method = solver.external)
        std::erase_if(all, [&](const Setting& s) { return s.value < method->least || s.value > method->most; });
    return all;
}

/// Detects when finer settings no longer help.
class Floor {
public:
    explicit Floor(double error) : floor_(error) {}

    bool reached(double error) {
        constexpr double near = 100, useful = 1e-3;
        constexpr int patience = 3, long_patience = 8;
        ++since_best_;
        if (error < best_) {
            best_ = error;
            since_best_ = 0;
        }
        return since_best_ >= (best_ < near * floor_ ? patience : best_ < useful ? long_patience : never);
    }

private:
    static constexpr int never = std::numeric_limits<int>::max();
    double floor_, best_ = std::numeric_limits<double>::infinity();
    int since_best_ = 0;
};

constexpr double long_enough_s = 1e-3;  // for a clock error of some tenths of a percent
constexpr double warm_enough_s = 3e-3;  // for cold caches not to count
constexpr long most_runs = 32;          // at a time: all fit into the first-level cache

template <class Run>
double cpu_of(Run&& run) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    run();
    return seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

long runs_for(double cpu_s) {
    return std::clamp(static_cast<long>(std::ceil(long_enough_s / std::max(cpu_s, 1e-9))), 1L, most_runs);
}

MotionSpec spec_of(const WorkProblem& problem, const Solver& solver, const Setting& setting) {
    auto spec = problem.motion_in(solver.model);
    spec.method = solver.method;
    spec.steps_per_sample = setting.steps;
    spec.tolerance = setting.tolerance;
    return spec;
}

/// Tells a run that broke down: not finite, or energy or rods out of all proportion.
class Proportion {
public:
    Proportion(const WorkProblem& problem, const Observation& start)
        : gain_(greatest_gain(start.energy, start.kinetic_energy, problem.energy_unit)), size_(problem.size) {}
    bool holds(const Observation& seen) const {
        return std::isfinite(seen.energy_change) && seen.energy_change <= gain_ && seen.length_error <= size_;
    }

private:
    double gain_, size_;  // J, m
};

/// Worst energy and length errors, as seen some 240 times on the way. False where the run broke down.
bool find_worst_errors(const WorkProblem& problem, MotionSpec spec, Rung& rung, const std::atomic<bool>& stop) {
    constexpr long samples_wanted = 240;
    long samples = samples_wanted;
    if (const long steps = spec.steps_per_sample; steps > 0) {
        // the same steps, some of them between two samples
        spec.steps_per_sample = (steps + samples_wanted - 1) / samples_wanted;
        spec.sample_interval = *product(spec.sample_interval, *reduced(spec.steps_per_sample, steps));
        samples = steps / spec.steps_per_sample;
    } else {
        spec.sample_interval = *quotient(spec.sample_interval, {samples, 1});
    }
    const auto motion = make_motion(spec);
    const auto start = motion->observe();
    const Proportion proportion(problem, start);
    const double scale = energy_scale(start.energy, problem.energy_unit);
    double energy = 0, length = 0;
    for (long i = 0; i < samples; ++i) {
        motion->advance(stop);
        const auto seen = motion->observe();
        if (!proportion.holds(seen)) return false;
        energy = std::max(energy, std::abs(seen.energy_change) / scale);
        length = std::max(length, seen.length_error);
    }
    rung.energy_error = problem.conserves_energy ? energy : NAN;
    rung.length_error = length;
    return true;
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

Rung motion_rung(const WorkProblem& problem, const ReferenceSolution& solution, const Solver& solver,
                 const Setting& setting, const LadderSpec& spec, const std::atomic<bool>& stop) {
    auto rung = no_rung;
    rung.setting = setting.value;
    const auto motion_spec = spec_of(problem, solver, setting);
    const auto motion = make_motion(motion_spec);
    const Proportion proportion(problem, motion->observe());
    const auto take_effort = [&] {
        rung.evaluations = static_cast<double>(motion->effort().evaluations);
        rung.steps = static_cast<double>(motion->effort().steps);
    };
    try {
        const double first_s = cpu_of([&] { motion->advance(stop); });
        take_effort();
        const auto end = motion->observe();
        if (!proportion.holds(end) || (spec.watched && !find_worst_errors(problem, motion_spec, rung, stop)))
            return rung;
        rung.error = problem.error(end, solution.reference);
        if (!std::isfinite(rung.error)) return rung;
        if (spec.timed) rung.cpu_s = timed(motion_spec, first_s, stop);
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::method_failed) throw;
        take_effort();
        rung.error = NAN;
    }
    return rung;
}

/// A chain in the state θ1 … θN, ω1 … ωN.
Observation observed(const Pendulum<double>& chain, std::span<const double> state) {
    Observation seen;
    seen.bobs = bobs_of_angles(chain, State<double, Eigen::Dynamic>(Eigen::Map<const Eigen::VectorXd>(
                                          state.data(), static_cast<Eigen::Index>(state.size()))));
    seen.energy = energy(seen.bobs, chain.gravity);
    seen.kinetic_energy = kinetic_energy(seen.bobs);
    return seen;
}

Rung external_rung(const WorkProblem& problem, const ReferenceSolution& solution, const ExternalMethod& method,
                   const Setting& setting, const LadderSpec& spec) {
    auto rung = no_rung;
    rung.setting = setting.value;
    const auto chain = problem.motion.chain->cast<double>();
    auto release = chain.angle;
    release.insert(release.end(), chain.rate.begin(), chain.rate.end());
    const auto start = observed(chain, release);
    try {
        const auto run = method.make(chain, problem.duration(), setting.value);
        const double first_s = cpu_of([&] { run->run(); });
        rung.evaluations = static_cast<double>(run->evaluations());
        rung.steps = static_cast<double>(run->steps());
        auto end = observed(chain, run->state());
        end.energy_change = end.energy - start.energy;
        if (!Proportion(problem, start).holds(end)) return rung;
        rung.error = problem.error(end, solution.reference);
        if (!std::isfinite(rung.error)) rung.error = NAN;
        if (!spec.timed) return rung;
        const long runs = runs_for(first_s);
        const double all = cpu_of([&] {
            for (long i = 0; i < runs; ++i) run->run();
        });
        rung.cpu_s = first_s > warm_enough_s ? first_s : all / static_cast<double>(runs);
    } catch (const Error& fault) {
        if (fault.code() != ExitCode::method_failed) throw;
    }
    return rung;
}

}  // namespace

bool Solver::serves(const WorkProblem& problem) const {
    switch (problem.kind) {
        case WorkProblem::Kind::chain:
            return true;
        case WorkProblem::Kind::bodies:
            return model == Model::angles && !external;
        case WorkProblem::Kind::mechanism:
            return model == Model::mechanism && !external;
    }
    return false;
}

MotionSpec WorkProblem::motion_in(Model model) const {
    auto spec = motion;
    spec.model = model;
    if (model != Model::mechanism) spec.parts.reset();
    return spec;
}

double WorkProblem::error(const Observation& end, const Reference& reference) const {
    return has_angles() ? angle_error(end.bobs, reference.end) : place_error(end.bobs, reference.end) / size;
}

ReferenceSolution reference_solution(const WorkProblem& problem, const std::atomic<bool>& stop) {
    // quad at its tolerance comes to some 1e-30 of the sensitivity; that of a mechanism is not known
    constexpr double allowed = 1e-26, allowed_blindly = 1e-15;
    const bool is_mechanism = problem.kind == WorkProblem::Kind::mechanism;
    const auto spec = problem.motion_in(is_mechanism ? Model::mechanism : Model::angles);
    if (problem.kind != WorkProblem::Kind::chain)
        return {reference_end(spec, spec.sample_interval, allowed_blindly, stop), NAN};
    const double sensitivity = angle_sensitivity(spec.chain->cast<double>(), problem.duration(), stop);
    return {reference_end(spec, spec.sample_interval, allowed * std::max(sensitivity, 1.0), stop), sensitivity};
}

bool Solver::adaptive() const {
    return external ? external->adaptive : find_method(method)->adaptive;
}

std::vector<Rung> run_ladder(const WorkProblem& problem, const ReferenceSolution& solution, const Solver& solver,
                             const LadderSpec& spec, const std::atomic<bool>& stop) {
    const auto rung_at = [&](const Setting& setting) {
        throw_if_set(stop);
        return solver.external ? external_rung(problem, solution, *solver.external, setting, spec)
                               : motion_rung(problem, solution, solver, setting, spec, stop);
    };
    std::vector<Rung> rungs;
    Floor floor(solution.floor());
    for (const auto& setting : settings(problem, solver, spec)) {
        const auto& rung = rungs.emplace_back(rung_at(setting));
        const bool enough = std::numbers::sqrt2 * rung.evaluations > static_cast<double>(spec.most_evaluations);
        if (enough || rung.error < spec.least_error || floor.reached(rung.error)) break;
    }
    if (solver.is_study() && std::none_of(rungs.begin(), rungs.end(), [](auto& r) { return r.is_study(); })) {
        const double steps = std::round(problem.duration() / study_step);
        rungs.push_back(rung_at({problem.duration() / steps, static_cast<long>(steps), 0}));
    }
    if (rungs.empty()) rungs.push_back(no_rung);
    return rungs;
}

}  // namespace doppel

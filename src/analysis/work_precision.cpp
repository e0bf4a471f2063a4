#include "analysis/work_precision.hpp"

#include "analysis/breakdown.hpp"
#include "base/clock.hpp"
#include "integrate/methods.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

namespace doppel {

MotionSpec WorkProblem::motion_in(Model model) const {
    auto spec = motion;
    spec.model = model;
    if (model != Model::mechanism) spec.parts.reset();
    return spec;
}

Reference WorkProblem::reference(const std::atomic<bool>& stop) const {
    const auto model = kind == Kind::mechanism ? Model::mechanism : Model::angles;
    return reference_end(motion_in(model), motion.sample_interval, stop);
}

bool Solver::serves(const WorkProblem& problem) const {
    if (problem.kind == WorkProblem::Kind::chain) return true;
    return !external && model == (problem.kind == WorkProblem::Kind::bodies ? Model::angles : Model::mechanism);
}

namespace {

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
    constexpr int finest = 30;
    std::vector<Setting> all;
    for (int k = 2; k <= finest; ++k) {
        const auto tolerance = parse_quad(fmt::format("{}e-{}", k % 2 == 0 ? "1" : "0.316", k / 2));
        all.push_back({static_cast<double>(tolerance), 0, tolerance});
    }
    return all;
}

std::vector<Setting> settings(const WorkProblem& problem, const Solver& solver, const LadderSpec& spec) {
    const auto* external = solver.external;
    const bool adaptive = external ? external->adaptive : find_method(solver.method)->adaptive;
    auto all = adaptive ? tolerance_settings() : step_settings(problem, spec);
    if (external)
        std::erase_if(all, [&](const Setting& s) { return s.value < external->least || s.value > external->most; });
    return all;
}

template <class Run>
double cpu_of(Run&& run) {
    const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    run();
    return seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
}

/// A solver at one setting, on a problem.
class Trial {
public:
    Trial(const WorkProblem& problem, const Solver& solver, const Setting& setting, const std::atomic<bool>& stop)
        : problem_(problem), solver_(solver), setting_(setting), stop_(stop), spec_(problem.motion_in(solver.model)) {
        spec_.method = solver.method;
        spec_.steps_per_sample = setting.steps;
        spec_.tolerance = setting.tolerance;
    }

    Rung rung(const Reference& reference, const LadderSpec& spec) const {
        Rung rung{setting_.value, NAN, NAN, NAN, NAN, NAN, NAN};
        const auto motion = made();
        const auto proportion = proportion_of(*motion);
        bool ends = false;
        const double first_s = cpu_of([&] { ends = advanced(*motion, stop_); });
        rung.evaluations = static_cast<double>(motion->effort().evaluations);
        rung.steps = static_cast<double>(motion->effort().steps);
        if (!ends || !proportion.holds(motion->observe()) || (spec.watched && !solver_.external && !is_sound(rung)))
            return rung;
        const double off =
            ErrorMeasure{problem_.has_angles(), problem_.size}.distance(motion->observe(), reference.end);
        if (!std::isfinite(off)) return rung;
        rung.error = off;
        if (spec.timed) rung.cpu_s = timed(first_s);
        return rung;
    }

private:
    std::unique_ptr<Motion> made() const {
        if (!solver_.external) return make_motion(spec_);
        return solver_.external->make(spec_.chain->cast<double>(), problem_.duration(), setting_.value);
    }
    Proportion proportion_of(const Motion& motion) const {
        return {motion.observe(), problem_.energy_unit, problem_.size};
    }

    /// The worst errors of energy and lengths, as seen some 240 times on the way. False where the run breaks down.
    bool is_sound(Rung& rung) const {
        constexpr long samples_wanted = 240;
        long samples = samples_wanted;
        auto spec = spec_;
        if (const long steps = spec.steps_per_sample; steps > 0) {
            // the same steps, some of them between two samples
            spec.steps_per_sample = (steps + samples_wanted - 1) / samples_wanted;
            spec.sample_interval = *product(spec.sample_interval, *reduced(spec.steps_per_sample, steps));
            samples = steps / spec.steps_per_sample;
        } else {
            spec.sample_interval = *quotient(spec.sample_interval, {samples, 1});
        }
        const auto motion = make_motion(spec);
        const auto proportion = proportion_of(*motion);
        double energy = 0, length = 0;
        for (long i = 0; i < samples; ++i) {
            if (!advanced(*motion, stop_)) return false;
            const auto seen = motion->observe();
            if (!proportion.holds(seen)) return false;
            energy = std::max(energy, proportion.energy_error(seen));
            length = std::max(length, seen.length_error);
        }
        rung.energy_error = problem_.conserves_energy ? energy : NAN;
        rung.length_error = length;
        return true;
    }

    /// Seconds of CPU for one run; `first_s` is what it took the first time.
    double timed(double first_s) const {
        constexpr double long_enough_s = 1e-3;  // for a clock error of some tenths of a percent
        constexpr double warm_enough_s = 3e-3;  // for cold caches not to count
        constexpr long most_runs = 32;          // at a time: all fit into the first-level cache
        if (first_s > warm_enough_s) return first_s;
        const auto wanted = static_cast<long>(std::ceil(long_enough_s / std::max(first_s, 1e-9)));
        std::vector<std::unique_ptr<Motion>> motions(static_cast<std::size_t>(std::clamp(wanted, 1L, most_runs)));
        for (auto& motion : motions) motion = made();
        const double all = cpu_of([&] {
            for (const auto& motion : motions) motion->advance(stop_);
        });
        return all / static_cast<double>(motions.size());
    }

    const WorkProblem& problem_;
    const Solver& solver_;
    Setting setting_;
    const std::atomic<bool>& stop_;
    MotionSpec spec_;
};

/// Of sorted values, between two of them in proportion.
double quantile(const std::vector<double>& sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const auto above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

double cost_of(const Rung& rung, Cost cost) {
    return cost == Cost::time ? rung.cpu_s : rung.evaluations;
}

/// The rungs of a ladder that may be drawn.
void add_points(const Ladder& ladder, Cost cost, const ErrorRange& range, std::vector<WorkPoint>& points) {
    const auto& rungs = ladder.rungs;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const double error = rungs[i].error, spent = cost_of(rungs[i], cost);
        const bool is_lucky = i + 1 < rungs.size() && error > range.least && !(rungs[i + 1].error <= 2 * error);
        if (error <= range.most && spent > 0 && !is_lucky) points.push_back({spent, error, ladder.spread[i]});
    }
}

/// Those that no cheaper one beats, until one is at the floor.
std::vector<WorkPoint> front_of(std::vector<WorkPoint> points, double floor) {
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return a.cost < b.cost || (a.cost == b.cost && a.error < b.error);
    });
    std::vector<WorkPoint> front;
    for (const auto& point : points) {
        if (!front.empty() && front.back().error <= floor) break;
        if (front.empty() || point.error < front.back().error) front.push_back(point);
    }
    return front;
}

/// Of the ladders that count.
template <class Counts>
Cheapest cheapest_of(const std::vector<Ladder>& all, Cost cost, double error, const Counts& counts) {
    Cheapest best;
    for (const auto& ladder : all) {
        const auto& rungs = ladder.rungs;
        if (!counts(ladder)) continue;
        for (std::size_t i = 0; i < rungs.size(); ++i) {
            const bool holds = rungs[i].error <= error && (i + 1 == rungs.size() || rungs[i + 1].error <= error);
            const double value = cost_of(rungs[i], cost);
            if (holds && value > 0 && value < best.cost) best = {&ladder, value};
        }
    }
    return best;
}

bool is_same_method(const Ladder& one, const Ladder& other) {
    return one.problem == other.problem && one.solver.name() == other.solver.name();
}

}  // namespace

std::vector<Rung> run_ladder(const WorkProblem& problem, const Reference& reference, const Solver& solver,
                             const LadderSpec& spec, const std::atomic<bool>& stop) {
    double best = std::numeric_limits<double>::infinity();
    long since_best = 0;
    // finer settings no longer help
    const auto is_at_floor = [&](double error) {
        constexpr double near = 100, useful = 1e-3;
        constexpr long patience = 3, long_patience = 8;
        ++since_best;
        if (error < best) {
            best = error;
            since_best = 0;
        }
        return best < near * reference.floor() ? since_best >= patience : best < useful && since_best >= long_patience;
    };
    const auto rung_at = [&](const Setting& setting) {
        return Trial(problem, solver, setting, stop).rung(reference, spec);
    };
    std::vector<Rung> rungs;
    for (const auto& setting : settings(problem, solver, spec)) {
        const auto& rung = rungs.emplace_back(rung_at(setting));
        const bool enough = std::numbers::sqrt2 * rung.evaluations > static_cast<double>(spec.most_evaluations);
        if (enough || rung.error < spec.least_error || is_at_floor(rung.error)) break;
    }
    if (solver.is_study() && std::none_of(rungs.begin(), rungs.end(), [](auto& r) { return r.is_study(); })) {
        const double steps = std::round(problem.duration() / study_step);
        rungs.push_back(rung_at({problem.duration() / steps, static_cast<long>(steps), 0}));
    }
    if (rungs.empty()) rungs.push_back({NAN, NAN, NAN, NAN, NAN, NAN, NAN});
    return rungs;
}

Ladder merged(std::size_t problem, const Solver& solver, const std::vector<std::vector<Rung>>& repeats) {
    Ladder ladder{problem, solver, repeats.front(), {}};
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i) {
        std::vector<double> times;
        for (const auto& rungs : repeats)
            if (i < rungs.size() && std::isfinite(rungs[i].cpu_s)) times.push_back(rungs[i].cpu_s);
        auto& spread = ladder.spread.emplace_back(0);
        if (times.empty() || ladder.rungs[i].failed()) continue;  // the repeats do not look on the way
        std::sort(times.begin(), times.end());
        ladder.rungs[i].cpu_s = quantile(times, 0.5);
        spread = (quantile(times, 0.75) - quantile(times, 0.25)) / 2 / ladder.rungs[i].cpu_s;
    }
    return ladder;
}

std::vector<WorkPoint> front_of(const Ladder& ladder, Cost cost, const ErrorRange& range) {
    std::vector<WorkPoint> points;
    add_points(ladder, cost, range, points);
    return front_of(std::move(points), range.least);
}

std::vector<WorkPoint> front_of(std::size_t problem, const std::vector<Ladder>& all, Cost cost,
                                const ErrorRange& range) {
    std::vector<WorkPoint> points;
    for (const auto& ladder : all)
        if (ladder.problem == problem && !ladder.solver.external) add_points(ladder, cost, range, points);
    return front_of(std::move(points), range.least);
}

Cheapest cheapest(std::size_t problem, const std::vector<Ladder>& all, Cost cost, double error, bool external) {
    return cheapest_of(all, cost, error, [&](const Ladder& ladder) {
        return ladder.problem == problem && (ladder.solver.external != nullptr) == external;
    });
}

std::vector<const Ladder*> best_models(std::size_t problem, const std::vector<Ladder>& all, Cost cost) {
    constexpr int decades = 13;
    const auto wins = [&](const Ladder& ladder) {
        int count = 0;
        for (int decade = 1; decade <= decades; ++decade) {
            const double error = std::pow(10.0, -decade);
            const auto own = cheapest_of(all, cost, error, [&](auto& one) { return &one == &ladder; });
            const auto any = cheapest_of(all, cost, error, [&](auto& one) { return is_same_method(one, ladder); });
            count += own.ladder && own.cost == any.cost;
        }
        return count;
    };
    std::vector<const Ladder*> best;
    for (const auto& ladder : all) {
        if (ladder.problem != problem) continue;
        const auto known =
            std::find_if(best.begin(), best.end(), [&](auto* one) { return is_same_method(*one, ladder); });
        if (known == best.end())
            best.push_back(&ladder);
        else if (wins(ladder) > wins(**known))
            *known = &ladder;
    }
    std::sort(best.begin(), best.end());
    return best;
}

std::vector<std::string> ranked(const std::vector<Ladder>& all, Cost cost, std::span<const double> errors,
                                bool external) {
    std::vector<std::string> names;
    std::set<std::size_t> problems;
    for (const auto& ladder : all) {
        if ((ladder.solver.external != nullptr) != external) continue;
        problems.insert(ladder.problem);
        if (std::find(names.begin(), names.end(), ladder.solver.name()) == names.end())
            names.push_back(ladder.solver.name());
    }
    std::map<std::string, long> ranks;
    for (const std::size_t problem : problems)
        for (const double error : errors) {
            std::vector<double> costs;
            for (const auto& name : names)
                costs.push_back(cheapest_of(all, cost, error, [&](const Ladder& ladder) {
                                    return ladder.problem == problem && ladder.solver.name() == name;
                                }).cost);
            for (std::size_t i = 0; i < names.size(); ++i)
                ranks[names[i]] +=
                    std::count_if(costs.begin(), costs.end(), [&](double other) { return other < costs[i]; });
        }
    std::stable_sort(names.begin(), names.end(), [&](auto& one, auto& other) { return ranks[one] < ranks[other]; });
    return names;
}

std::pair<double, double> time_spread(const std::vector<Ladder>& all) {
    std::vector<double> spreads;
    for (const auto& ladder : all)
        for (const auto& point : front_of(ladder, Cost::time, {0, 1})) spreads.push_back(point.spread);
    if (spreads.empty()) return {NAN, NAN};
    std::sort(spreads.begin(), spreads.end());
    return {spreads[spreads.size() / 2], spreads.back()};
}

}  // namespace doppel

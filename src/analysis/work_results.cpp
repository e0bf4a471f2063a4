#include "analysis/work_ladder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace doppel {
namespace {

/// Of sorted values, between two of them in proportion.
double quantile(const std::vector<double>& sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const auto above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

/// Whether the next finer setting errs more than twice as much: then so good an end was luck.
bool is_lucky(const Ladder& ladder, std::size_t i, const ErrorRange& range) {
    const auto& rungs = ladder.rungs;
    return i + 1 < rungs.size() && rungs[i].error > range.least && !(rungs[i + 1].error <= 2 * rungs[i].error);
}

bool is_same_method(const Ladder& one, const Ladder& other) {
    return one.problem == other.problem && one.solver.name() == other.solver.name();
}

}  // namespace

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

std::vector<std::size_t> useful_rungs(const Ladder& ladder, Cost cost, const ErrorRange& range) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < ladder.rungs.size(); ++i)
        if (ladder.rungs[i].error <= range.most && cost_of(ladder.rungs[i], cost) > 0 && !is_lucky(ladder, i, range))
            order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return cost_of(ladder.rungs[a], cost) < cost_of(ladder.rungs[b], cost);
    });
    std::vector<std::size_t> useful;
    for (const std::size_t i : order) {
        if (!useful.empty() && ladder.rungs[useful.back()].error <= range.least) break;
        if (useful.empty() || ladder.rungs[i].error < ladder.rungs[useful.back()].error) useful.push_back(i);
    }
    return useful;
}

std::optional<double> cost_at(const Ladder& ladder, Cost cost, double error) {
    std::optional<double> least;
    const auto& rungs = ladder.rungs;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
        const bool holds = rungs[i].error <= error && (i + 1 == rungs.size() || rungs[i + 1].error <= error);
        const double value = cost_of(rungs[i], cost);
        if (holds && value > 0 && (!least || value < *least)) least = value;
    }
    return least;
}

std::vector<const Ladder*> best_models(std::size_t problem, const std::vector<Ladder>& all, Cost cost) {
    constexpr int decades = 13;
    std::vector<int> wins(all.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        for (int decade = 1; decade <= decades; ++decade) {
            const double error = std::pow(10.0, -decade);
            const auto own = cost_at(all[i], cost, error);
            const bool beaten = !own || std::any_of(all.begin(), all.end(), [&](const Ladder& other) {
                const auto value = is_same_method(all[i], other) ? cost_at(other, cost, error) : std::nullopt;
                return value && *value < *own;
            });
            if (!beaten) ++wins[i];
        }
    std::vector<const Ladder*> best;
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].problem != problem) continue;
        bool most = true;
        for (std::size_t k = 0; k < all.size(); ++k)
            if (is_same_method(all[i], all[k])) most &= wins[k] < wins[i] || (wins[k] == wins[i] && k >= i);
        if (most) best.push_back(&all[i]);
    }
    return best;
}

std::vector<FrontPoint> front_of(std::size_t problem, const std::vector<Ladder>& all, Cost cost,
                                 const ErrorRange& range) {
    std::vector<FrontPoint> points, front;
    for (const auto& ladder : all) {
        if (ladder.problem != problem || ladder.solver.external) continue;
        for (const std::size_t i : useful_rungs(ladder, cost, range))
            points.push_back({cost_of(ladder.rungs[i], cost), ladder.rungs[i].error});
    }
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
        return a.cost < b.cost || (a.cost == b.cost && a.error < b.error);
    });
    for (const auto& point : points) {
        if (!front.empty() && front.back().error <= range.least) break;
        if (front.empty() || point.error < front.back().error) front.push_back(point);
    }
    return front;
}

std::pair<double, double> time_spread(const std::vector<Ladder>& all) {
    std::vector<double> spreads;
    for (const auto& ladder : all)
        for (const std::size_t i : useful_rungs(ladder, Cost::time, {0, 1})) spreads.push_back(ladder.spread[i]);
    if (spreads.empty()) return {NAN, NAN};
    std::sort(spreads.begin(), spreads.end());
    return {spreads[spreads.size() / 2], spreads.back()};
}

std::vector<std::string> ranked(const std::vector<Ladder>& all, Cost cost, std::span<const double> errors,
                                bool external) {
    std::vector<std::string> names;
    std::vector<std::size_t> problems;
    for (const auto& ladder : all) {
        if ((ladder.solver.external != nullptr) != external) continue;
        const auto add = [](auto& list, const auto& value) {
            if (std::find(list.begin(), list.end(), value) == list.end()) list.push_back(value);
        };
        add(names, ladder.solver.name());
        add(problems, ladder.problem);
    }
    constexpr double never = std::numeric_limits<double>::infinity();
    std::vector<long> ranks(names.size());
    for (const std::size_t problem : problems)
        for (const double error : errors) {
            std::vector<double> costs(names.size(), never);
            for (const auto& ladder : all) {
                const auto at = std::find(names.begin(), names.end(), ladder.solver.name()) - names.begin();
                if (ladder.problem != problem || at == static_cast<long>(names.size())) continue;
                auto& least = costs[static_cast<std::size_t>(at)];
                least = std::min(least, cost_at(ladder, cost, error).value_or(never));
            }
            for (std::size_t i = 0; i < names.size(); ++i)
                ranks[i] += std::count_if(costs.begin(), costs.end(), [&](double other) { return other < costs[i]; });
        }
    std::vector<std::size_t> order(names.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
    std::vector<std::string> best;
    for (const std::size_t i : order) best.push_back(names[i]);
    return best;
}

std::optional<Cheapest> cheapest(std::size_t problem, const std::vector<Ladder>& all, Cost cost, double error,
                                 bool external) {
    std::optional<Cheapest> best;
    for (const auto& ladder : all) {
        if (ladder.problem != problem || (ladder.solver.external != nullptr) != external) continue;
        if (const auto value = cost_at(ladder, cost, error); value && (!best || *value < best->cost))
            best = {&ladder, *value};
    }
    return best;
}

}  // namespace doppel

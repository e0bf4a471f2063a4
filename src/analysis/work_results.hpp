#pragma once

#include "analysis/work_ladder.hpp"

#include <optional>
#include <utility>

namespace doppel {

/// A ladder as measured: CPU times are medians over the repeats.
struct Ladder {
    std::size_t problem;
    Solver solver;
    std::vector<Rung> rungs;
    std::vector<double> spread;  // of each rung's CPU time: half the range of its middle half, relative
};

/// What a run costs.
enum class Cost { time, evaluations };
inline double cost_of(const Rung& rung, Cost cost) {
    return cost == Cost::time ? rung.cpu_s : rung.evaluations;
}

/// The ladder of several repeats, the first of which has everything.
Ladder merged(std::size_t problem, const Solver& solver, const std::vector<std::vector<Rung>>& repeats);

/// The range of errors shown; what is below `least` is at the floor.
struct ErrorRange {
    double least, most;
};

/// Its rungs that no cheaper one of its own beats, cheapest first, until one is at the floor. A rung whose next finer
/// one errs more than twice as much was lucky and does not count.
std::vector<std::size_t> useful_rungs(const Ladder& ladder, Cost cost, const ErrorRange& range);

/// What it takes to err by no more than `error`: the cheapest rung that does so, and whose next finer one does, too,
/// for now and then a coarse one is lucky. Nothing where none does.
std::optional<double> cost_at(const Ladder& ladder, Cost cost, double error);

/// Of each method on a problem the model that is the cheapest at most powers of ten of the error; of equals the first.
std::vector<const Ladder*> best_models(std::size_t problem, const std::vector<Ladder>& all, Cost cost);

/// A point of the front: no ladder of Doppel's methods errs less at less cost.
struct FrontPoint {
    double cost, error;
};
std::vector<FrontPoint> front_of(std::size_t problem, const std::vector<Ladder>& all, Cost cost,
                                 const ErrorRange& range);

/// Median and greatest spread of the CPU times of all useful rungs; NaN where there are none.
std::pair<double, double> time_spread(const std::vector<Ladder>& all);

/// The ladder that gets to `error` at the least cost, of Doppel's methods or of the external ones.
struct Cheapest {
    const Ladder* ladder;
    double cost;
};
std::optional<Cheapest> cheapest(std::size_t problem, const std::vector<Ladder>& all, Cost cost, double error,
                                 bool external);

}  // namespace doppel

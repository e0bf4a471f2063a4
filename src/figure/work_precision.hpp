#pragma once

#include "analysis/work_precision.hpp"
#include "figure/kinds.hpp"

#include <array>

namespace doppel {

template <>
inline constexpr auto names_of<Cost> = std::to_array<std::string_view>({"time", "evaluations"});

/// Which curves are labelled.
enum class NamedCurves { best, all };
template <>
inline constexpr auto names_of<NamedCurves> = std::to_array<std::string_view>({"best", "all"});

/// What a work-precision figure compares, and its results: the interface for a chart that adds methods of other
/// libraries (tests/bench/peers/library_chart.cpp).
struct WorkComparison {
    using Studies = std::vector<std::vector<StepStudy>>;  // for each problem

    std::vector<WorkProblem> problems;  // selected by [work_precision]
    Cost cost = Cost::time;
    NamedCurves names = NamedCurves::best;
    int repeats = 5, max_evaluations = 300'000;
    double min_error = 1e-16;

    virtual ~WorkComparison() = default;
    /// The reference of a problem; computed on first use, by any thread. Throws Error (exit 130) soon after `stop` is set.
    virtual const Reference& reference(std::size_t problem, const std::atomic<bool>& stop) const = 0;
    /// The step-size studies of each problem, with the medians of repeated times. `numbers` = those of all trials.
    virtual Studies merged_studies(std::span<const TrialNumbers> numbers) const = 0;
};

/// What a caption says of measured times: their number, median and largest spread.
std::string timing_caption(const WorkComparison::Studies& studies, int repeats);

/// Errors, rad, for which the cheapest method is named.
inline constexpr std::array accuracies{1e-3, 1e-6, 1e-9, 1e-12};
inline constexpr std::size_t best_shown = 5;  // methods in colour
inline constexpr double max_error_shown = 1;  // rad, or relative to the size

struct WorkDiagram {
    const WorkProblem& problem;
    double floor;                      // smallest error that the problem's sensitivity allows in double; NaN if unknown
    std::span<const StepStudy> front;  // whose Pareto front is shown as a pale band
    std::span<const StepStudy> studies;  // shown as curves
    Cost cost;
    const std::vector<std::string>& named;  // coloured methods
    NamedCurves names = NamedCurves::best;
};

/// Error against cost, a curve for each method in its best model: the named ones in colour, the others pale.
Plot work_plot(const WorkDiagram& diagram);

}  // namespace doppel

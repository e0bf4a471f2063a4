#pragma once

#include "analysis/work_precision.hpp"
#include "figure/kinds.hpp"

namespace doppel {

template <>
inline constexpr auto names_of<Cost> = std::to_array<std::string_view>({"time", "evaluations"});

/// Which curves are labelled.
enum class NamedCurves { best, all };
template <>
inline constexpr auto names_of<NamedCurves> = std::to_array<std::string_view>({"best", "all"});

/// The problems selected by [work_precision].
struct WorkProblems {
    std::vector<WorkProblem> all;
    std::string subtitle;  // the system
    std::string comment;   // other data that the numbers depend on, as TOML comments
};
/// The standard problems of these names, listed in `table`'s key `problems`. Throws Error (exit 2).
WorkProblems standard_problems(const std::vector<std::string>& names, const TomlReader& table);
std::span<const std::string_view> standard_problem_names();
WorkProblems problem_of(Preset film);

inline constexpr double max_error_shown = 1;  // rad, or relative to the size

struct WorkDiagram {
    const WorkProblem& problem;
    double floor;  // smallest error that the problem's sensitivity allows in double; NaN if unknown
    const std::vector<StepStudy>& studies;  // those of other libraries last
    Cost cost;
    const std::vector<std::string>& named;  // coloured methods, the best first: Solver::name()
    bool of_libraries;                      // the pale curves are those of other libraries, otherwise Doppel's
    NamedCurves names = NamedCurves::best;
};

/// Error against cost, a curve for each method in its best model: the named ones in colour, the others pale. Behind
/// them, a pale band follows the front of Doppel's methods.
Plot work_plot(const WorkDiagram& diagram);

}  // namespace doppel

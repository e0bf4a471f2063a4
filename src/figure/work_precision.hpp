#pragma once

#include "analysis/work_precision.hpp"
#include "figure/kinds.hpp"

namespace doppel {

template <>
inline constexpr auto names_of<Cost> = std::to_array<std::string_view>({"time", "evaluations"});

/// Whose names stand at their curves.
enum class NamedCurves { best, all };
template <>
inline constexpr auto names_of<NamedCurves> = std::to_array<std::string_view>({"best", "all"});

/// The problems that a preset's [work_precision] asks for.
struct WorkProblems {
    std::vector<WorkProblem> all;
    std::string subtitle;  // what moves
    std::string comment;   // what else the numbers depend on, TOML
};
/// Those of the standard that are named. `table` = whose key `problems` has the names. Throws Error (exit 2).
WorkProblems standard_problems(const std::vector<std::string>& names, const TomlReader& table);
std::span<const std::string_view> standard_problem_names();
WorkProblems problem_of(Preset film);

inline constexpr double most_error_shown = 1;  // rad, or of the size

/// Everything that the diagram of one problem shows.
struct WorkDiagram {
    const WorkProblem& problem;
    double floor;                           // that the problem's sensitivity sets in double; NaN where it is not known
    const std::vector<StepStudy>& studies;  // those of other libraries last
    Cost cost;
    const std::vector<std::string>& named;  // what is in colour, the best first: Solver::name()
    bool of_libraries;                      // what is faint is theirs, else Doppel's
    NamedCurves names = NamedCurves::best;
};

/// Error over cost, a curve for each method in its best model: those that are named in colour, the others faint. Behind
/// them a pale band along the front of Doppel's methods.
Plot work_plot(const WorkDiagram& diagram);

}  // namespace doppel

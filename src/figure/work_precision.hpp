#pragma once

#include "analysis/work_results.hpp"
#include "figure/kinds.hpp"

namespace doppel {

/// The problems that a preset's [work_precision] asks for. Throws Error (exit 2).
struct WorkProblems {
    std::vector<WorkProblem> all;
    std::string subtitle;  // what moves
    std::string comment;   // what else the numbers depend on, TOML
};
WorkProblems read_problems(SettingsReader& table);

/// Everything that the diagram of one problem shows.
struct WorkDiagram {
    std::size_t index;
    const WorkProblem& problem;
    double floor;  // that the problem's sensitivity sets in double; NaN where it is not known
    const std::vector<Ladder>& ladders;
    Cost cost;
};

/// Error over cost, a curve for each method: its best model plain, the others faint. Behind them a pale band along the
/// front, and methods of other libraries in grey.
Plot work_plot(const WorkDiagram& diagram);

}  // namespace doppel

#pragma once

#include "figure/work_results.hpp"

namespace doppel {

/// Everything that a chart of one problem shows.
struct WorkPanel {
    std::size_t index;
    const WorkProblem& problem;
    double floor;  // that the problem's sensitivity sets in double; NaN where it is not known
    const std::vector<Ladder>& ladders;
    Cost cost;
};

/// Error over cost, a curve for each method: its best model plain, the others faint. Under them a pale band along the
/// front, and peers in grey.
Plot work_plot(const WorkPanel& panel);

}  // namespace doppel

#pragma once

#include "film/recording.hpp"
#include "output/csv.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

// The table of a pair or a single pendulum has one row per sample, and the same columns for every model.

std::vector<std::string> columns_of(const Scene& scene);
/// The columns that are `chosen`: names of columns, or "a" or "b" for all of a side; all columns if it is empty. Throws
/// Error (exit 2) for an unknown column.
std::vector<std::string> columns_of(const Scene& scene, const std::vector<std::string>& chosen);

/// The numbers of a row in all columns; NaN for empty cells. `start_distance` = the distance of the pair at sample 0,
/// the reference of log_ratio.
std::vector<double> numbers_of(const Scene& scene, const Snapshot& snapshot, double start_distance);
/// Writes the row, of quad numbers all digits. Throws Error (exit 4), as Csv does.
void add_row(Csv& table, const Scene& scene, const Snapshot& snapshot, double start_distance);

}  // namespace doppel

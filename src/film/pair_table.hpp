#pragma once

#include "film/recording.hpp"
#include "output/csv.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

std::vector<std::string> columns_of(const Scene& scene);
/// The numbers of a row in all columns; NaN for empty cells.
std::vector<double> numbers_of(const Scene& scene, const Snapshot& snapshot, double start_distance);
/// The columns that are `chosen`: names of columns, or "a" or "b" for all of a side; all columns if it is empty. Throws
/// Error (exit 2) for an unknown column.
std::vector<std::string> columns_of(const Scene& scene, const std::vector<std::string>& chosen);

/// The table of a pair or a single pendulum, one row per sample; the same columns for every model. Throws Error (exit
/// 4), as Csv does.
class PairTable {
public:
    PairTable(const std::filesystem::path& place, const Scene& scene, const std::vector<std::string>& chosen)
        : scene_(scene), csv_(place, columns_of(scene), columns_of(scene, chosen)) {}

    /// `start_distance` = the distance of the pair at sample 0, the reference of log_ratio. Throws Error (exit 3) if
    /// the distance exceeds the range of double.
    void add(const Snapshot& snapshot, double start_distance);
    void finish() { csv_.finish(); }

private:
    /// Writes all digits.
    void add_exact(const Quad& value);

    const Scene& scene_;
    Csv csv_;
};

}  // namespace doppel

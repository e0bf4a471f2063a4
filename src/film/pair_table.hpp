#pragma once

#include "film/recording.hpp"
#include "output/csv.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// All columns of the scene's table.
std::vector<std::string> columns_of(const Scene& scene);
/// Those of them that are `chosen`, by name or as "a" or "b", all of a side; all where none is. Throws Error (exit 2)
/// where there is no such column.
std::vector<std::string> columns_of(const Scene& scene, const std::vector<std::string>& chosen);

/// The table of a pair, or of a single pendulum, a row a sample; the same columns for every model. Throws Error (exit
/// 4), as Csv does.
class PairTable {
public:
    /// `chosen` as in columns_of().
    PairTable(const std::filesystem::path& place, const Scene& scene, const std::vector<std::string>& chosen)
        : scene_(scene), csv_(place, columns_of(scene), columns_of(scene, chosen)) {}

    /// `start_distance` = the pair's distance at sample 0, to which log_ratio refers. Throws Error (exit 3) where the
    /// distance is beyond the range of double.
    void add(const Snapshot& snapshot, double start_distance);
    void finish() { csv_.finish(); }

private:
    void add_side(const Side& side, const Observation& seen, std::optional<double> energy_error);
    template <class Scalar>
    void add_bobs(const Side& side, const Bobs<Scalar>& bobs);
    void add(double value) { csv_.add(value); }
    /// With all digits.
    void add(const Quad& value);

    const Scene& scene_;
    Csv csv_;
};

}  // namespace doppel

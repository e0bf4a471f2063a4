#pragma once

#include "output/csv.hpp"
#include "scene/scene.hpp"

namespace doppel {

/// The table of a pair, a row a sample; the same columns for every model. Throws Error (exit 4), as Csv does.
class PairTable {
public:
    PairTable(const FilePlace& place, const Scene& scene);

    /// `start_distance` = the pair's distance at sample 0, to which log_ratio refers. Throws Error (exit 3) where the
    /// distance is beyond the range of double.
    void add(const Moment& moment, double start_distance);
    void finish() { csv_.finish(); }

private:
    void add_side(const Side& side, const Observation& seen, std::optional<double> energy_error);

    const Scene& scene_;
    Csv csv_;
};

}  // namespace doppel

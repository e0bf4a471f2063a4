#pragma once

#include <cmath>

namespace doppel {

/// Cells from `from` to `to`, evenly or in even ratios.
struct MapCells {
    double from, to;
    int count;
    bool logarithmic;

    double middle(int cell) const {
        const double part = (cell + 0.5) / count;
        return logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
    }
};

}  // namespace doppel

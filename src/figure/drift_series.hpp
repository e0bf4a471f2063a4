#pragma once

#include "figure/series.hpp"

namespace doppel {

/// Long-term errors of energy and rod lengths, every method at the same cost: the series of `errors`. Throws Error
/// (exit 2).
std::shared_ptr<const Experiment> drift_series(FigureReader& reader, const TomlReader& table, SeriesKeys& keys);

}  // namespace doppel

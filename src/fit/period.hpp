#pragma once

#include "fit/shooting.hpp"

#include <optional>

namespace doppel {

/// Pieces that follow one another at even intervals on a clock that each begins anew.
struct Period {
    double seconds = 0, standard_error = 0;
};

/// The interval at which the fitted motion leads from each piece to the next; nothing where no interval up to four
/// times a piece stands out.
std::optional<Period> find_period(const FitJob& job, const Fit& fit);

}  // namespace doppel

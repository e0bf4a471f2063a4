#pragma once

#include "fit/uncertainty.hpp"

#include <optional>
#include <vector>

namespace doppel {

/// A prediction from the beginning of a unit of the track. Each unit is compared with parameters that were fitted
/// without it and without the first one.
struct Prediction {
    double start_s = 0;                 // on the track's clock
    double data_s = 0;                  // length of the data from which the start was fitted
    double within_s = 0;                // time after the data for which the error stayed within the limit
    std::optional<double> left_s;       // when the error first exceeded the limit; nothing if the track ended before
    bool left_in_gap = false;           // between two pieces
    std::vector<double> time_s, error;  // after the data: rad, the larger of both links
    std::optional<double> start_alone_s,
        parameters_alone_s;  // until the effect of one standard error reaches the limit
};

struct Horizon {
    double limit = 0.1;  // rad
    std::vector<Prediction> predictions;
    std::optional<double> median_s;  // by Kaplan and Meier; nothing if fewer than half exceeded the limit
    double longest_s = 0;            // observed within the limit
    /// Counts of what ended the predictions that exceeded the limit: the model (if neither errors of the start nor of
    /// the parameters explain it), the start, the parameters.
    std::array<int, 3> left_by{};
    /// Predictions that left in a gap, and neither errors of the start nor of the parameters explain it: the pieces may be
    /// separate motions. They count as ended by the track.
    int ended_by_gap = 0;
    int left() const { return left_by[0] + left_by[1] + left_by[2]; }
};

/// The median of times of which some are only lower bounds (false).
/// Source  Kaplan & Meier 1958
std::optional<double> median_of(std::vector<std::pair<double, bool>> times);

/// Makes predictions from every unit of the track; the track's `start_s` gives the start times of pieces.
Horizon measure_horizon(const FitJob& job, const Fit& fit, const Uncertainty& uncertainty);

}  // namespace doppel

#pragma once

#include "fit/uncertainty.hpp"

#include <optional>
#include <vector>

namespace doppel {

/// A prediction from the beginning of a unit of the track. Every unit is judged by parameters that were fitted without
/// it and without the first.
struct Prediction {
    double start_s = 0;                 // on the track's clock
    double data_s = 0;                  // of it, from which the start was fitted
    double within_s = 0;                // after these: how long it was seen within the limit
    std::optional<double> left_s;       // when it was first seen beyond; nothing where the track ended before
    std::vector<double> time_s, error;  // after the data: rad, the larger of both links'
    std::optional<double> start_alone_s, parameters_alone_s;  // until one standard error of these reaches the limit
};

struct Horizon {
    double limit = 0.1;  // rad
    std::vector<Prediction> predictions;
    std::optional<double> median_s;  // Kaplan and Meier's; nothing where fewer than half left
    double longest_s = 0;            // seen within the limit
    /// Of the predictions that left what ended them: where neither the error of the start nor that of the parameters
    /// explains it, the model; start; parameters.
    std::array<int, 3> left_by{};
    int left() const { return left_by[0] + left_by[1] + left_by[2]; }
};

/// The median of times of which some are only known to be longer.
/// Source  Kaplan & Meier 1958
std::optional<double> median_of(std::vector<std::pair<double, bool>> times);

/// Predicts from every unit of the track; its `start_s` says where pieces are.
Horizon measure_horizon(const FitJob& job, const Fit& fit, const Uncertainty& uncertainty);

}  // namespace doppel

#pragma once

#include "fit/segment.hpp"

#include <atomic>
#include <vector>

namespace doppel {

/// The track that is fitted, until `stop` is set, on so many threads.
struct FitJob {
    const Track& track;
    const std::atomic<bool>& stop;
    int threads = 1;
};

/// A model fitted to a track by multiple shooting: every segment has a start of its own, all share the parameters.
struct Fit {
    ModelSpec model;
    FitRules rules;
    Parameters parameters{};
    std::vector<TrackSegment> segments;
    std::vector<ArmState<double>> starts;  // by segment, at its first sample
    std::vector<SegmentSums> sums;         // there
    double cost = 0, rms = 0;              // rms of the residuals, rad
    int passes = 0;                        // over all segments, of this fit

    double of(FitParameter parameter) const { return parameters[index_of(parameter)]; }
    /// Friction that would be negative, and is 0.
    bool is_at_bound(FitParameter parameter) const { return model.is_bounded(parameter) && of(parameter) <= 0; }
    /// How many parameters are fitted, without those at a bound.
    std::size_t free_count() const;
    long residual_count() const;
    /// As it is before it is evaluated.
    Fit without_sums() const;
};

/// How far to go.
struct FitEffort {
    int most_passes = 30;
    bool finds_scale = true;   // of the residuals, from what the model leaves; else that of the start is kept
    double step_share = 0.02;  // of the residuals' scale, by which the motion may err: steps are halved; 0: they stay
    double relative = 1e-6;    // ends where a step gains less than this share of the cost
};

/// Minimises Huber's loss of all residuals over starts and parameters: Gauss–Newton steps damped as Levenberg and
/// Marquardt do, the starts eliminated segment by segment, friction kept ≥ 0. `start` has model, parameters, segments and
/// starts; what sums it has are those there.
/// Ends after at most most_passes + 60 passes (two in each of 20 rounds, and what finds a scale and steps). The result is
/// the same bits for any number of threads. Throws Error: exit 3 where no motion stays finite, 130.
///
/// Source  Bock 1983 (multiple shooting); Nocedal & Wright, Numerical Optimization, §10.3.
Fit fit_model(const FitJob& job, Fit start, const FitEffort& effort);

/// Sums, cost and rms where `fit` stands.
void evaluate_fit(const FitJob& job, Fit& fit, double block_s = 0);

/// The inverse of a positive semidefinite matrix; 0 for what nothing depends on.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

/// The normal matrix of the fitted parameters and the slope, the start eliminated, of one segment.
struct Reduced {
    Eigen::MatrixXd of_start;  // the inverse of the start's own matrix, damped
    Eigen::MatrixXd matrix;
    Eigen::VectorXd slope;
};
Reduced reduced(const SegmentSums& sums, double damping = 0);

/// The fit of the whole track without some of its segments (their numbers), to first order: one Gauss–Newton step with the normal
/// equations of the others. Starts move along.
Fit fit_without(const Fit& fit, const std::vector<std::size_t>& segments);

/// Angles and rates at the first sample of a segment, from the samples around it.
ArmState<double> guessed_start(const Track& track, const TrackSegment& segment);

}  // namespace doppel

#pragma once

#include "fit/segment.hpp"

#include <atomic>
#include <vector>

namespace doppel {

/// A model fitted to a track by multiple shooting: every segment has a start of its own, all share the parameters.
struct Fit {
    ModelSpec model;
    FitRules rules;
    Parameters parameters{};
    std::vector<ArmState<double>> starts;  // by segment, at its first sample
    std::vector<SegmentSums> sums;         // there
    std::vector<FitParameter> at_bound;    // friction that would be negative, and is 0
    double cost = 0, rms = 0;              // rms of the residuals, rad
    std::vector<Residual> residuals;       // segment after segment
    int passes = 0;                        // over all segments, of this fit

    /// Those of the fitted that are not at a bound, in their order, and their places in `model.fitted`.
    std::vector<FitParameter> free() const;
    std::vector<Eigen::Index> free_places() const;
};

/// How far to go.
struct FitEffort {
    int most_passes = 30;
    bool finds_scale = true;  // of the residuals, from what the model leaves; else that of the start is kept
    bool finds_step = true;   // small enough that the motion errs by less than `step_share` of the residuals' scale
    double step_share = 0.02;
    double relative = 1e-6;  // ends where a step gains less than this share of the cost
    int jobs = 1;
};

/// Minimises Huber's loss of all residuals over starts and parameters: Gauss–Newton steps damped as Levenberg and
/// Marquardt do, the starts eliminated segment by segment, friction kept ≥ 0. `start` has model, parameters and starts; what
/// sums it has are those there.
/// Ends after at most most_passes + 60 passes (two in each of 20 rounds, and what finds a scale and steps). The result is
/// the same bits for any number of jobs. Throws Error: exit 3 where no motion stays finite, 130.
///
/// Source  Bock 1983 (multiple shooting); Nocedal & Wright, Numerical Optimization, §10.3.
Fit fit_model(const Track& track, const std::vector<TrackSegment>& segments, Fit start, const FitEffort& effort,
              const std::atomic<bool>& stop);

/// Sums, residuals, cost and rms where `fit` stands.
void evaluate_fit(const Track& track, const std::vector<TrackSegment>& segments, Fit& fit, int jobs,
                  const std::atomic<bool>& stop, double block_s = 0);

/// The normal matrix of the free parameters and the slope, starts eliminated, of one segment.
struct Reduced {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd slope;
};
Reduced reduced(const SegmentSums& sums, const std::vector<Eigen::Index>& places);

/// The fit with other parameters, nearby: the starts follow as far as they are linear.
Fit moved(const Fit& fit, const std::vector<Eigen::Index>& places, const Eigen::VectorXd& change);

/// The largest change of an angle, rad, when the integrator's step is halved.
double step_error(const Track& track, const std::vector<TrackSegment>& segments, const Fit& fit,
                  const std::atomic<bool>& stop);

}  // namespace doppel

#pragma once

#include "fit/arms.hpp"
#include "track/track.hpp"

#include <Eigen/Core>

#include <vector>

namespace doppel {

/// How residuals are measured and weighed.
struct FitRules {
    double step_s = 0.016;                    // of the integrator, to begin with
    std::array<double, 2> scale{1e-3, 1e-3};  // of each arm's residuals, rad
    /// Huber's loss: residuals beyond this many scales count in proportion, not squared. Of pure noise that loses 0.2 %
    /// of what it tells.
    static constexpr double bend = 3;
};

/// What one segment adds to the normal equations of its start (four numbers, first) and the fitted parameters.
struct SegmentSums {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd slope;
    double cost = 0;                               // Huber's, in squared scales; infinite where the motion ran away
    double bounded = 0;                            // Σ (residual/scale)², each at most bend²
    double squares = 0;                            // Σ residual², rad²
    long count = 0, beyond = 0;                    // of residuals, and of those beyond the bend
    std::vector<std::array<double, 2>> residuals;  // measured − model of each sample's angles, rad; NaN of outliers
    std::vector<Eigen::VectorXd> blocks;           // where asked for: slopes of successive stretches
};

/// The residuals of a segment whose arms start in `start` at its first sample, and how they change with start and
/// parameters: exact derivatives of the computed motion, carried along. `block_s`: of the stretches; 0 = none.
SegmentSums evaluate_segment(const Track& track, const TrackSegment& segment, const ModelSpec& model,
                             const FitRules& rules, const Parameters& parameters, const ArmState<double>& start,
                             double block_s = 0);

}  // namespace doppel

#pragma once

#include "track/model.hpp"
#include "track/track.hpp"

#include <Eigen/Core>

#include <vector>

namespace doppel {

/// Which numbers of a model are fitted, and what it is like otherwise.
struct ModelSpec {
    bool point_masses = false;  // then D1 = A D2/C, and gravity_1 is not among `fitted`
    Drag drag = Drag::own;
    DryLaw dry = DryLaw::smooth;
    std::vector<FitParameter> fitted;
    bool may_gain = false;  // friction may be negative

    /// Whether it is friction that must not be negative.
    bool is_bounded(FitParameter parameter) const { return is_friction(parameter) && !may_gain; }
};

/// The parameters with those that follow from others.
Parameters completed(const ModelSpec& model, Parameters parameters);
Arms<double> arms_of(const ModelSpec& model, const Parameters& parameters);

/// How residuals are measured and weighed.
struct FitRules {
    double step_s = 0.016;                    // of the integrator, to begin with
    std::array<double, 2> scale{1e-3, 1e-3};  // of each arm's residuals, rad
    /// Huber's loss: residuals beyond this many scales count in proportion, not squared. Of pure noise that loses 0.2 %
    /// of what it tells.
    static constexpr double bend = 3;
};

/// One residual, measured − model, rad.
struct Residual {
    std::size_t segment, sample, arm;
    double measured, residual;
};

/// What one segment adds to the normal equations, with starts s (four) and parameters p:
///     [ starts  mixed  ] [Δs]   [start_slope]
///     [ mixedᵀ  shared ] [Δp] = [shared_slope]
struct SegmentSums {
    Eigen::Matrix4d starts = Eigen::Matrix4d::Zero();
    Eigen::MatrixXd mixed, shared;
    Eigen::Vector4d start_slope = Eigen::Vector4d::Zero();
    Eigen::VectorXd shared_slope;
    double cost = 0;     // Huber's, in squared scales; infinite where the motion ran away
    double bounded = 0;  // Σ (residual/scale)², each at most bend²
    double squares = 0;  // Σ residual², rad²
    std::array<double, 2> arm_squares{};
    long count = 0;                       // of residuals
    std::vector<Eigen::VectorXd> blocks;  // where asked for: slopes (four, then p) of successive stretches
};

/// How many residuals a segment has: two a sample, without outliers.
std::size_t residual_count(const Track& track, const TrackSegment& segment);

/// What to keep besides.
struct SegmentExtras {
    Residual* residuals = nullptr;  // room for residual_count() of them
    double block_s = 0;             // length of the stretches; 0 = none
};

/// The residuals of a segment whose arms start in `start` at its first sample, and how they change with start and
/// parameters: exact derivatives of the computed motion, carried along.
SegmentSums evaluate_segment(const Track& track, const ModelSpec& model, const FitRules& rules,
                             const Parameters& parameters, const ArmState<double>& start, const TrackSegment& segment,
                             std::size_t number = 0, const SegmentExtras& extras = {});

}  // namespace doppel

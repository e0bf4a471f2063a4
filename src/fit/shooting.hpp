#pragma once

#include "base/error.hpp"
#include "fit/pendulum.hpp"
#include "track/track.hpp"

#include <optional>
#include <span>
#include <vector>

namespace doppel {

/// The track that is fitted, until `stop` is set, on so many threads.
struct FitJob {
    const Track& track;
    const std::atomic<bool>& stop;
    int threads = 1;
};

/// Of all parameters; 0 for those that are not fitted.
using ParameterMatrix = Eigen::Matrix<double, parameter_count, parameter_count>;

/// What a shot adds to the normal equations: Σ rows rowsᵀ, of each residual the derivatives of what is shown by the start (four
/// numbers), itself, and the derivatives by the parameters (0 where not fitted), by the root of its weight.
struct ShotSums {
    using Row = Eigen::Matrix<double, 5 + parameter_count, 1>;
    Eigen::Matrix<double, Row::SizeAtCompileTime, Row::SizeAtCompileTime> normal = decltype(normal)::Zero();
    double cost = 0;                               // Huber's, in squared scales; infinite where the motion ran away
    double bounded = 0;                            // Σ (residual/scale)², each at most bend²
    double squares = 0;                            // Σ residual², rad²
    long count = 0, beyond = 0;                    // of residuals, and of those beyond the bend
    std::vector<std::array<double, 2>> residuals;  // measured − model of each sample's angles, rad; NaN of outliers
    std::vector<Row> blocks;                       // where asked for: Σ residual · row of successive stretches

    /// The inverse of the start's own matrix, its diagonal damped; 0 for what nothing depends on.
    Eigen::Matrix4d inverse_of_start(double damping = 0) const;
    /// The rest of the equations, the start eliminated: of the residual, then of the parameters.
    Eigen::Matrix<double, 1 + parameter_count, 1 + parameter_count> reduced(double damping = 0) const;
};

/// Samples first … last − 1 of a piece, which one motion follows from a start of its own.
struct Shot {
    std::size_t piece = 0, first = 0, last = 0;
    std::size_t unit = 0;   // what is left out together: a piece, or a stretch where there are few pieces
    std::size_t whole = 0;  // the stretch of which it is a part
    ArmState start{};       // at the first sample
    ShotSums sums;          // there

    std::size_t size() const { return last - first; }
};

/// A model fitted to a track by multiple shooting: every shot has a start of its own, all share the parameters.
struct Fit {
    ModelSpec model;
    Parameters parameters = Parameters::Zero();
    std::vector<Shot> shots;                  // in the order of the track
    double step_s = 0.016;                    // of the integrator, to begin with
    std::array<double, 2> scale{1e-3, 1e-3};  // of each link's residuals, rad
    bool is_evaluated = false;                // the shots' sums, cost and rms are those of what stands above
    double cost = 0, rms = 0;                 // rms of the residuals, rad
    int passes = 0;                           // over all shots, of this fit

    /// Huber's loss: residuals beyond this many scales count in proportion, not squared. Of pure noise that loses 0.2 %
    /// of what it tells.
    static constexpr double bend = 3;

    bool is_bounded(std::size_t k) const { return model.fitted[k] && is_friction(k) && !model.may_gain; }
    /// Friction that would be negative, and is 0.
    bool is_at_bound(std::size_t k) const { return is_bounded(k) && parameters[k] <= 0; }
    /// How many parameters are fitted, without those at a bound.
    std::size_t free_count() const;
    long residual_count() const;
    std::size_t units() const { return shots.back().unit + 1; }
    std::span<const Shot> unit(std::size_t number) const;
};

/// How far to go.
struct FitEffort {
    int most_passes = 30;
    bool finds_scale = true;   // of the residuals, from what the model leaves; else that of the start is kept
    double step_share = 0.02;  // of the residuals' scale, by which the motion may err: steps are halved; 0: they stay
    double relative = 1e-6;    // ends where a step gains less than this share of the cost
};

/// Minimises Huber's loss of all residuals over starts and parameters: Gauss–Newton steps damped as Levenberg and
/// Marquardt do, the starts eliminated shot by shot, friction kept ≥ 0. Nothing where no motion stays finite.
/// Ends after at most most_passes + 60 passes (two in each of 20 rounds, and what finds a scale and steps). The result is
/// the same bits for any number of threads. Throws Error (exit 130).
///
/// Source  Bock 1983 (multiple shooting); Nocedal & Wright, Numerical Optimization, §10.3.
std::optional<Fit> fit_model(const FitJob& job, Fit start, const FitEffort& effort);

/// The same of some shots of a fit with its parameters, of which the starts alone are fitted.
std::optional<Fit> fit_starts(const FitJob& job, const Fit& fit, std::span<const Shot> shots, int most_passes,
                              double relative);

/// What to throw where no motion stays finite (exit 3).
Error no_motion(const Track& track);

/// Sums, cost and rms where `fit` stands: exact derivatives of the computed motion, carried along. `block_s`: of the
/// stretches; 0 = none.
void evaluate_fit(const FitJob& job, Fit& fit, double block_s = 0);

/// The inverse of a positive semidefinite matrix; 0 for what nothing depends on.
ParameterMatrix inverse_of(const ParameterMatrix& matrix);

constexpr auto no_unit = static_cast<std::size_t>(-1);

/// A fit after one Gauss–Newton step, damped, by the normal equations of all units but two, which may be the same: to first
/// order, the fit of a track without them. Starts move along. Its cost is the one that is expected.
Fit stepped(const Fit& fit, double damping, std::size_t without, std::size_t other);

/// Angles and rates at a sample of a piece, from the samples around it.
ArmState guessed_start(const Track& track, std::size_t piece, std::size_t sample);

}  // namespace doppel

#pragma once

#include "base/error.hpp"
#include "fit/pendulum.hpp"
#include "numeric/solvers.hpp"
#include "track/track.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace doppel {

/// The track to fit, the number of threads, and the stop flag.
struct FitJob {
    const Track& track;
    const std::atomic<bool>& stop;
    int threads = 1;
};

/// For all parameters; 0 for those that are not fitted.
using ParameterMatrix = Eigen::Matrix<double, parameter_count, parameter_count>;

/// The contribution of a shot to the normal equations: Σ row rowᵀ. Each row belongs to a residual. It contains the
/// derivatives of the measured value by the start (four numbers), the residual, and the derivatives by the parameters
/// (0 if not fitted). It is multiplied by the root of its weight.
struct ShotSums {
    using Row = Eigen::Matrix<double, 5 + parameter_count, 1>;
    Eigen::Matrix<double, Row::SizeAtCompileTime, Row::SizeAtCompileTime> normal = decltype(normal)::Zero();
    double cost = 0;                               // Huber's loss, in squared scales; infinite if the motion diverged
    double bounded = 0;                            // Σ (residual/scale)², each at most bend²
    double squares = 0;                            // Σ residual², rad²
    long count = 0, beyond = 0;                    // numbers of residuals, and of those beyond the bend
    std::vector<std::array<double, 2>> residuals;  // measured − model of each sample's angles, rad; NaN for outliers
    std::vector<Row> blocks;                       // on request: Σ residual · row of consecutive stretches

    /// The inverse of the start's own matrix with damped diagonal; 0 for directions without influence.
    Eigen::Matrix4d inverse_of_start(double damping = 0) const;
    /// The other equations with the start eliminated: for the residual, then for the parameters.
    Eigen::Matrix<double, 1 + parameter_count, 1 + parameter_count> reduced(double damping = 0) const;
};

/// Samples first … last − 1 of a piece, described by one motion with its own start.
struct Shot {
    std::size_t piece = 0, first = 0, last = 0;
    std::size_t unit = 0;   // what is left out together: a piece, or a stretch if there are few pieces
    std::size_t whole = 0;  // number of the stretch that contains it
    LinkState start{};      // at the first sample
    ShotSums sums;          // there

    std::size_t size() const { return last - first; }
};

/// A model fitted to a track by multiple shooting: every shot has its own start; all share the parameters.
struct Fit {
    ModelSpec model;
    Parameters parameters = Parameters::Zero();
    std::vector<Shot> shots;                  // in the order of the track
    double step_s = 0.016;                    // initial step size of the integrator
    std::array<double, 2> scale{1e-3, 1e-3};  // of each link's residuals, rad
    bool is_evaluated = false;                // the shots' sums, cost and rms belong to the values above
    double cost = 0, rms = 0;                 // rms of the residuals, rad
    int passes = 0;                           // evaluations of all shots during this fit

    /// Huber's loss: residuals beyond this many scales count linearly instead of squared. For pure noise this loses 0.2
    /// % of the information.
    static constexpr double bend = 3;

    bool is_bounded(std::size_t k) const { return model.fitted[k] && is_friction(k) && !model.may_gain; }
    /// Whether the parameter is a friction at its lower bound 0.
    bool is_at_bound(std::size_t k) const { return is_bounded(k) && parameters[k] <= 0; }
    /// The number of fitted parameters that are not at a bound.
    std::size_t free_count() const;
    long residual_count() const;
    std::size_t units() const { return shots.back().unit + 1; }
    std::span<const Shot> unit(std::size_t number) const;
};

struct FitEffort {
    int max_passes = 30;
    bool finds_scale =
        true;  // finds the scale of the residuals, from what the model leaves; otherwise the initial one is kept
    double step_share =
        0.02;  // allowed integration error relative to the scale; steps are halved to reach it; 0: steps are kept
    double relative = 1e-6;  // stops if a step gains less than this share of the cost
};

/// Minimises Huber's loss of all residuals over starts and parameters: Gauss–Newton steps with Levenberg–Marquardt
/// damping, the starts eliminated shot by shot, friction kept ≥ 0. Nothing if no motion stays finite. Takes at most
/// max_passes + 60 passes (two in each of 20 rounds, and some to find scale and step size). The result has the same
/// bits for any number of threads. Throws Error (exit 130).
///
/// Source  Bock 1983 (multiple shooting); Nocedal & Wright, Numerical Optimization, §10.3.
std::optional<Fit> fit_model(const FitJob& job, Fit start, const FitEffort& effort);

/// The same for some shots of a fit with its parameters; only their starts are fitted.
std::optional<Fit> fit_starts(const FitJob& job, const Fit& fit, std::span<const Shot> shots, int max_passes,
                              double relative);

/// The error if no motion stays finite (exit 3).
Error no_motion(const Track& track);

/// Evaluates sums, cost and rms of `fit`, with exact derivatives of the computed motion. `block_s`: length of the
/// stretches; 0 = none.
void evaluate_fit(const FitJob& job, Fit& fit, double block_s = 0);

/// The inverse of a positive semidefinite matrix; 0 for unknowns without influence, NaN if it is not finite.
template <class Matrix>
Matrix inverse_of(Matrix matrix) {
    if (!matrix.allFinite()) return Matrix::Constant(std::nan(""));
    Matrix inverse = Matrix::Identity();
    for (Eigen::Index k = 0; k < matrix.rows(); ++k)
        if (matrix(k, k) == 0) matrix(k, k) = 1, inverse(k, k) = 0;
    solve_positive_definite(matrix, inverse);
    return inverse;
}

constexpr auto no_unit = static_cast<std::size_t>(-1);

/// A fit after one damped Gauss–Newton step with the normal equations of all units except two, which may be the same:
/// to first order, the fit without these units. Starts are updated. Its cost is the expected one.
Fit stepped(const Fit& fit, double damping, std::size_t without, std::size_t other);

/// Angles and rates at a sample of a piece, estimated from the samples around it.
LinkState estimated_start(const Track& track, std::size_t piece, std::size_t sample);

}  // namespace doppel

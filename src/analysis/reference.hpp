#pragma once

#include "integrate/motion.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace doppel {

/// The distance of two motions: the largest difference of any angle modulo whole turns, rad; for mechanisms, of
/// positions in units of `reach`. NaN if a number is NaN. Computed in quad if either motion is: in double, removing
/// turns would hide differences below 2e-16 per turn.
struct ErrorMeasure {
    bool in_angles = true;
    double reach = 1;  // m

    /// The angles, rad, or x and y of all particles, m.
    std::vector<Quad> coordinates(const Observation& seen) const;
    double distance(std::span<const Quad> one, std::span<const Quad> other) const;
    double distance(const Observation& one, const Observation& other) const {
        return distance(coordinates(one), coordinates(other));
    }
};

/// The end of a motion, to more digits than double has.
struct Reference {
    Observation end;      // angles modulo whole turns
    double disagreement;  // of the two computations: of angles, rad, or for mechanisms of positions, m
    /// The factor by which the motion amplifies an initial error: the largest |∂θ_i(T)/∂θ_j(0)|. NaN if it is no chain
    /// of point masses.
    double sensitivity;

    /// The error from rounding in double, which no method is expected to undercut; NaN if unknown.
    double floor() const { return 0x1p-53 * sensitivity; }
};

/// The end after `seconds` by Taylor series in quad, computed twice. A chain is computed in angles and as particles on
/// rods, which share no equation. Rigid-body chains and mechanisms are computed at two tolerances, and so two orders.
/// The sensitivity comes from neighbouring runs in quad. Of `spec`, only the system matters, and whether it is a
/// mechanism. Throws Error: exit 3 if the two results differ by more than the sensitivity and quad precision explain,
/// or a step cannot be made; exit 130 soon after `stop` is set.
Reference reference_end(MotionSpec spec, const Rational& seconds, const std::atomic<bool>& stop);

/// The most accurate motion available, sample by sample, by which the errors of a run are measured. For a motion in
/// double it is a Taylor series in quad: its error is a ten-thousandth of that of any run in double. If that costs too
/// much, and for a motion in quad, it is a Taylor series at the finest tolerance of the motion's precision; its error
/// is estimated from runs at another tolerance and from changed initial numbers.
struct ReferenceTrajectory : ErrorMeasure {
    std::vector<std::vector<Quad>> seen{};  // coordinates() at samples 0, 1 …
    /// Error bound of the reference, rad or units of `reach`; the maximum up to each sample. If `is_wider`, it is the
    /// effect of rounding the motion's numbers to its precision.
    std::vector<double> uncertainty{};
    bool is_wider = false;  // computed with more digits than the motion has
    std::string failure{};  // why it ended early

    /// The distance of a motion from the reference at a sample.
    double error_at(std::size_t sample, const Observation& observed) const {
        return distance(coordinates(observed), seen[sample]);
    }
    std::string description() const {
        return is_wider ? "Taylor series in quad" : "Taylor series at the smallest tolerance";
    }
};

/// The limit of the cost in quad, in evaluations of the right-hand side times links or particles: some two seconds.
inline constexpr double max_quad_work = 3e5;

/// Up to `samples`, or somewhat beyond the sample where the error of a run in the motion's own precision exceeds
/// `max_error`. The system is that of `spec`; its method does not matter. `max_work` in quad; 0 = none.
/// Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ReferenceTrajectory reference_trajectory(const MotionSpec& spec, long samples, double reach, double max_error,
                                         const std::atomic<bool>& stop, double max_work = max_quad_work);

/// The motion of `spec` by the method of a reference in the motion's own precision.
MotionSpec by_taylor_series(MotionSpec spec, const Quad& tolerance);

/// The error of a run: the maximum over all angles and all samples up to each one, rad; for mechanisms, of positions in
/// units of the size. The uncertainty of the reference is included.
struct ErrorHistory {
    std::vector<double> error;  // at samples 0, 1 …, up to the first that is too large
    Effort effort;              // of the run, as far as the reference goes
    long effort_samples = 0;    // number of samples of `effort`
    std::string failure;        // why the run or the reference ended early

    /// Infinity beyond the last known sample.
    double at(std::size_t sample) const {
        return sample < error.size() ? error[sample] : std::numeric_limits<double>::infinity();
    }
    /// The last sample before an error exceeds `allowed`; −1 = none.
    long last_within(double allowed) const {
        return std::upper_bound(error.begin(), error.end(), allowed) - error.begin() - 1;
    }
};

/// The error of `spec` compared with the reference, sample by sample, until it exceeds `max_error`, the run fails, or
/// the reference ends.
/// Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ErrorHistory error_history(const MotionSpec& spec, const ReferenceTrajectory& reference, double max_error,
                           const std::atomic<bool>& stop);

}  // namespace doppel

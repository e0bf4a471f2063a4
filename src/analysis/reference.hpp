#pragma once

#include "integrate/motion.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace doppel {

/// How far one motion is from another: rad, the largest of all angles, up to whole turns; of what hangs in no chain, of
/// places in units of `reach`. NaN where a number is NaN. In quad, where either is: turns are then taken off in quad, or
/// nothing below their rounding in double, 2e-16 a turn, could be seen.
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

/// How a motion ends, to more digits than double has.
struct Reference {
    Observation end;      // angles up to whole turns
    double disagreement;  // of the two computations: of angles, rad, or of places, m, where there are none
    /// How much the motion makes of an error at its start: the largest |∂θ_i(T)/∂θ_j(0)|; NaN where it is no chain of point
    /// masses.
    double sensitivity;

    /// The error that rounding alone makes in double, which no method can be expected to beat; NaN where it is not known.
    double floor() const { return 0x1p-53 * sensitivity; }
};

/// The end after `seconds`, by Taylor series in quad, twice: a chain in angles and as particles on rods, which have no
/// equation in common; links with mass, friction or a drive and mechanisms at two tolerances, and so orders. The
/// sensitivity by runs in quad from next to the start. Of `spec` only what moves, and whether it is a mechanism, matters.
///
/// Throws Error: exit 3 where the two differ by more than quad makes of the sensitivity, or a step cannot be made; exit 130
/// soon after `stop` is set.
Reference reference_end(MotionSpec spec, const Rational& seconds, const std::atomic<bool>& stop);

/// The motion as well as it can be known, sample by sample: what the errors of a run are measured by.
///
/// Of a motion in double, by Taylor series in quad: wrong by a ten-thousandth of what any run in double is. Where that
/// would cost too much, and of a motion in quad, by Taylor series as fine as its own precision allows; how far those
/// may be off is told by others of another tolerance, from a start some roundings away.
struct ReferenceTrajectory : ErrorMeasure {
    std::vector<std::vector<Quad>> seen{};  // coordinates() at samples 0, 1 …
    /// How far that may be off: rad, or units of `reach`, the largest so far. Where `is_wider`, what one rounding of the
    /// motion's numbers to its precision does: they are not known better.
    std::vector<double> uncertainty{};
    bool is_wider = false;  // in more digits than the motion's own
    std::string failure{};  // why it could not go on

    /// How far a motion is from it at a sample that was seen.
    double off_at(std::size_t sample, const Observation& observed) const {
        return distance(coordinates(observed), seen[sample]);
    }
    std::string description() const {
        return is_wider ? "Taylor series in quad" : "Taylor series at the smallest tolerance";
    }
};

/// What quad may cost, in evaluations of the right-hand side times links or particles: some two seconds.
inline constexpr double most_quad_work = 3e5;

/// Up to `samples`, or somewhat beyond where a run in the motion's own precision would be off by more than `enough`.
/// The system is that of `spec`; its method does not matter. `most_work` of quad; 0 = none.
/// Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ReferenceTrajectory reference_trajectory(const MotionSpec& spec, long samples, double reach, double enough,
                                         const std::atomic<bool>& stop, double most_work = most_quad_work);

/// The motion of `spec` by the method of the reference in the motion's own precision.
MotionSpec by_taylor_series(MotionSpec spec, const Quad& tolerance);

/// How far a run is off, in rad, the largest of all angles and of all samples so far; of what hangs in no chain, of
/// places in units of its size. What the reference itself may be off by counts as well.
struct ErrorHistory {
    std::vector<double> error;  // at samples 0, 1 …, up to the first that is too great
    Effort effort;              // of the run, as far as the reference goes:
    long effort_samples = 0;    // up to that one
    std::string failure;        // why it, or the reference, could not go on

    /// Infinity where nothing was seen that far.
    double at(std::size_t sample) const {
        return sample < error.size() ? error[sample] : std::numeric_limits<double>::infinity();
    }
    /// The last sample before an error is greater; −1 = none.
    long last_within(double allowed) const {
        return std::upper_bound(error.begin(), error.end(), allowed) - error.begin() - 1;
    }
};

/// The run of `spec` beside the reference, sample by sample; errors until it is off by more than `enough`, fails,
/// or the reference ends. Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ErrorHistory error_history(const MotionSpec& spec, const ReferenceTrajectory& reference, double enough,
                           const std::atomic<bool>& stop);

}  // namespace doppel

#pragma once

#include "integrate/motion.hpp"

#include <string>
#include <vector>

namespace doppel {

/// How a motion ends, to more digits than double has.
struct Reference {
    Bobs<Quad> end;       // angles up to whole turns
    double disagreement;  // of the two computations: of angles, rad, or of places, m, where there are none
};

/// The end after `seconds`, by Taylor series in quad, twice: a chain in angles and as particles on rods, which have no
/// equation in common; links with mass, friction or a drive and mechanisms at two tolerances, and so orders. Of `spec` only
/// what moves, and whether it is a mechanism, matters.
///
/// Throws Error: exit 3 where the two differ by more than `allowed`, or a step cannot be made; exit 130 soon after
/// `stop` is set.
Reference reference_end(MotionSpec spec, const Rational& seconds, double allowed, const std::atomic<bool>& stop);

/// The motion as well as it can be known, sample by sample: what the errors of a run are measured by.
///
/// Of a motion in double, by Taylor series in quad: wrong by a ten-thousandth of what any run in double is. Where that
/// would cost too much, and of a motion in quad, by Taylor series as fine as its own precision allows; how far those
/// may be off is told by others of another tolerance, from a start some roundings away.
struct ReferenceTrajectory {
    bool in_angles = true;                // of a chain; else by places, in units of `reach`
    double reach = 1;                     // m
    std::vector<std::vector<Quad>> seen;  // at samples 0, 1 …: the angles, rad, or x and y of all particles, m
    /// How far that may be off: rad, or units of `reach`, the largest so far. Where `is_wider`, what one rounding of the
    /// motion's numbers to its precision does: they are not known better.
    std::vector<double> uncertainty;
    bool is_wider = false;  // in more digits than the motion's own
    std::string failure;    // why it could not go on

    /// How far a motion is from it at a sample that was seen: rad, the largest of all angles, up to whole turns; or of
    /// places, in units of `reach`. NaN where a number is NaN.
    double distance(std::size_t sample, const Observation& observed) const;
    std::string description() const;  // "Taylor series in quad"
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

/// The same system with its numbers some roundings away, those of its precision.
MotionSpec some_roundings_away(MotionSpec spec);

/// How far a run is off, in rad, the largest of all angles and of all samples so far; of what hangs in no chain, of
/// places in units of its size. What the reference itself may be off by counts as well.
struct ErrorHistory {
    std::vector<double> error;  // at samples 0, 1 …, up to the first that is too great
    Effort effort;              // of the run, as far as the reference goes:
    long effort_samples = 0;    // up to that one
    std::string failure;        // why it, or the reference, could not go on

    double at(std::size_t sample) const;     // infinity where nothing was seen that far
    long last_within(double allowed) const;  // the last sample before an error is greater; −1 = none
};

/// The run of `spec` beside the reference, sample by sample; errors until it is off by more than `enough`, breaks down,
/// or the reference ends. Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ErrorHistory error_history(const MotionSpec& spec, const ReferenceTrajectory& reference, double enough,
                           const std::atomic<bool>& stop);

}  // namespace doppel

#pragma once

#include "analysis/reference_course.hpp"

namespace doppel {

/// How far a run is off, in rad, the largest of all angles and of all samples so far; of what hangs in no chain, of
/// places in units of its size. What the reference itself may be off by counts as well.
struct ErrorCourse {
    std::vector<double> error;  // at samples 0, 1 …, up to the first that is too great
    Effort effort;              // of the run, as far as the reference goes:
    long effort_samples = 0;    // up to that one
    std::string failure;        // why it, or the reference, could not go on

    double at(std::size_t sample) const;     // infinity where nothing was seen that far
    long last_within(double allowed) const;  // the last sample before an error is greater; −1 = none
};

/// The run of `spec` beside the reference, sample by sample; errors until it is off by more than `enough`, breaks down,
/// or the reference ends. Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ErrorCourse error_course(const MotionSpec& spec, const ReferenceCourse& reference, double enough,
                         const std::atomic<bool>& stop);

}  // namespace doppel

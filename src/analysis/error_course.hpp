#pragma once

#include "integrate/motion.hpp"

#include <string>
#include <vector>

namespace doppel {

/// How far a run can be trusted, by its own evidence. Errors are in rad, the largest of all angles and of all samples
/// so far; of what hangs in no chain, those of places in units of `reach`.
struct ErrorCourse {
    std::vector<double> truncation;  // at samples 0, 1 …: against a run that steps more finely
    std::vector<double> rounding;    // against one from a start some roundings away
    Effort effort;                   // of the run itself
    std::string failure;             // why one of them could not go on

    /// At a sample, or later where nothing was seen that far.
    double error(std::size_t sample) const;
};

/// The run of `spec` beside one of `finer`, and one of itself from a start some roundings away, sample by sample, until
/// one is off by more than `enough`, breaks down, or `samples` are done.
/// Errors  exit 2 as make_motion(), exit 130 soon after `stop` is set.
ErrorCourse error_course(const MotionSpec& spec, const MotionSpec& finer, long samples, double reach, double enough,
                         const std::atomic<bool>& stop);

/// The same system with its numbers some roundings away, those of its precision: what they do to the motion is what
/// rounding may have done.
MotionSpec some_roundings_away(MotionSpec spec);

}  // namespace doppel

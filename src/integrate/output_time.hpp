#pragma once

#include "numeric/compensated.hpp"

#include <vector>

namespace doppel {

/// Where the output time of an adaptive method is, s from the start of its last step; in two parts, so that it neither
/// drifts nor coarsens. Steps taken to look ahead of it are subtracted when it comes to them: looking changes no bit.
template <class Scalar>
class OutputTime {
public:
    const Scalar& offset() const { return offset_; }

    /// So many seconds on.
    void advance(const Scalar& seconds) {
        add_compensated(offset_, lost_, seconds);
        for (const auto& step : steps_ahead_) pass(step);
        steps_ahead_.clear();
    }
    /// A step has been taken, and the next one starts at its end.
    void pass(const Scalar& step) { add_compensated(offset_, lost_, Scalar(-step)); }
    /// A step has been taken to look ahead.
    void note_step_ahead(const Scalar& step) { steps_ahead_.push_back(step); }

private:
    Scalar offset_ = Scalar(0), lost_ = Scalar(0);  // s
    std::vector<Scalar> steps_ahead_;               // s, that start before the last step and are not subtracted yet
};

}  // namespace doppel

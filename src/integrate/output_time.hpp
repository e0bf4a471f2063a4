#pragma once

#include "numeric/compensated.hpp"

#include <vector>

namespace doppel {

/// Where the output time of an adaptive method is, s from the start of its last step; as a sum of two, so that it neither
/// drifts nor coarsens. Steps taken to look ahead of it are subtracted when it comes to them: looking changes no bit.
template <class Scalar>
class OutputTime {
public:
    /// So many seconds on: next() takes the next step, which `step` is the length of, until the time lies in the last.
    template <class Next>
    Scalar advance(const Scalar& seconds, const Scalar& step, const Next& next) {
        add_compensated(offset_, lost_, seconds);
        for (const auto& ahead : steps_ahead_) pass(ahead);
        steps_ahead_.clear();
        while (offset_ > step) {
            pass(step);
            next();
        }
        return offset_;
    }
    /// Where it would be so many seconds on.
    template <class Next>
    Scalar look_ahead(const Scalar& seconds, const Scalar& step, const Next& next) {
        auto ahead = *this;
        return ahead.advance(seconds, step, [&] {
            steps_ahead_.push_back(step);
            next();
        });
    }

private:
    void pass(const Scalar& step) { add_compensated(offset_, lost_, Scalar(-step)); }

    Scalar offset_ = Scalar(0), lost_ = Scalar(0);  // s
    std::vector<Scalar> steps_ahead_;               // s, that start before the last step and are not subtracted yet
};

}  // namespace doppel

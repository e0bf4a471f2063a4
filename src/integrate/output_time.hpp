#pragma once

#include "numeric/compensated.hpp"

#include <vector>

namespace doppel {

/// The output time of an adaptive method, s from the start of its last step. It is stored as a sum of two, so that it
/// neither drifts nor loses precision. Steps taken to look ahead are subtracted when the time reaches them, so that
/// looking ahead changes no bit.
template <class Scalar>
class OutputTime {
public:
    /// Advances by `seconds`: calls next() for the next step, whose length is `step`, until the time lies in the last
    /// one.
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
    /// The output time after `seconds` more.
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
    std::vector<Scalar> steps_ahead_;  // s, lengths of steps before the last one that are not subtracted yet
};

}  // namespace doppel

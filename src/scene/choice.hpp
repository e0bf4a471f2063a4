#pragma once

#include "analysis/reference_course.hpp"
#include "scene/scene.hpp"

namespace doppel {

/// Chooses for one side by accuracy, any number of times: the reference that errors are measured by is computed once.
class Chooser {
public:
    /// Errors  exit 2 where the system is faulty, exit 130 soon after `stop` is set.
    Chooser(const SideSpec& spec, const Rational& duration, const Rational& sample_hz, const std::atomic<bool>& stop);

    /// The side by the model and method that take the least work, of those that the measured table has for this
    /// accuracy or a finer one (scene/cost_table.hpp), at the loosest setting whose error stays below eight tenths of
    /// `accuracy` (rad) to the end; or, where no setting's does, nearly as long as that of the finest. A finer accuracy
    /// never takes less work.
    /// Errors  exit 2 where the accuracy would not even hold for one swing, with what is within reach; exit 130.
    Side choose(double accuracy) const;

private:
    SideSpec spec_;
    Rational duration_, sample_hz_;
    const std::atomic<bool>& stop_;
    double time_unit_;  // s
    long samples_;
    ReferenceCourse reference_;
};

/// By the accuracy that the side itself asks for.
Side choose_side(const SideSpec& spec, const Rational& duration, const Rational& sample_hz,
                 const std::atomic<bool>& stop);

}  // namespace doppel

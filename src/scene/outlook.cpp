#include "scene/outlook.hpp"

#include "analysis/error_course.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double off = 0.5;  // rad: a run that errs by as much tells nothing

/// The motion by the best method there is, in the same precision.
MotionSpec finest(const Side& side, double tolerance) {
    auto motion = side.motion;
    motion.method = "taylor";
    motion.tolerance = tolerance;
    return motion;
}

}  // namespace

Outlook outlook(const Scene& scene, const Side& side, const std::atomic<bool>& stop) {
    const bool quad = side.motion.precision == Precision::in_quad;
    const auto reference = finest(side, quad ? 1e-32 : 1e-15);
    const auto course = error_course(side.motion, reference, scene.samples, side.reach, off, stop);
    if (course.truncation.empty()) throw method_failed("the method breaks down at once");
    Outlook seen{.error = course.truncation.back(),
                 .error_s = scene.time(static_cast<long>(course.truncation.size()) - 1)};

    constexpr std::size_t most_links = 12;
    if (side.motion.chain && side.motion.chain->links() <= most_links)
        seen.exponent = largest_exponent(side.motion.chain->cast<double>(), {}, stop);
    const auto motion =
        error_course(finest(side, quad ? 1e-30 : 1e-14), reference, scene.samples, side.reach, off, stop);
    const double last = motion.rounding.back(), last_s = scene.time(static_cast<long>(motion.rounding.size()) - 1);
    if (static_cast<long>(motion.rounding.size()) <= scene.samples)
        seen.horizon_s = last_s;
    else if (seen.exponent && !is_regular(*seen.exponent) && last > 0)
        seen.horizon_s = last_s + std::log(off / last) / seen.exponent->value;
    return seen;
}

}  // namespace doppel

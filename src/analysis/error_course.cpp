#include "analysis/error_course.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {

double ErrorCourse::at(std::size_t sample) const {
    return sample < error.size() ? error[sample] : std::numeric_limits<double>::infinity();
}

long ErrorCourse::last_within(double allowed) const {
    return std::upper_bound(error.begin(), error.end(), allowed) - error.begin() - 1;
}

ErrorCourse error_course(const MotionSpec& spec, const ReferenceCourse& reference, double enough,
                         const std::atomic<bool>& stop) {
    auto watched = spec;
    watched.follows_turns = watched.wants_tension = false;
    const auto run = make_motion(watched);
    ErrorCourse course;
    double worst = 0;
    for (std::size_t sample = 0; sample < reference.seen.size(); ++sample) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        try {
            if (sample > 0) run->advance(stop);
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::method_failed) throw;
            if (worst <= enough) course.failure = fault.what();
            return course;
        }
        course.effort = run->effort();
        course.effort_samples = static_cast<long>(sample);
        if (worst > enough) continue;
        const double off = reference.off(sample, run->observe()) + reference.doubt[sample];
        if (!std::isfinite(off)) return course;
        worst = std::max(worst, off);
        course.error.push_back(worst);
    }
    if (worst <= enough) course.failure = reference.failure;
    return course;
}

}  // namespace doppel

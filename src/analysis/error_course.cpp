#include "analysis/error_course.hpp"

#include "analysis/angle_error.hpp"
#include "numeric/error.hpp"

#include <algorithm>
#include <limits>

namespace doppel {
namespace {

double error_between(const Observation& one, const Observation& other, bool angles, double reach) {
    const auto between = [&](const auto& x, const auto& y) {
        return angles ? angle_error(x, y) : place_error(x, y) / reach;
    };
    return one.exact.empty() ? between(one.bobs, other.bobs) : between(one.exact, other.exact);
}

}  // namespace

double ErrorCourse::error(std::size_t sample) const {
    return sample < truncation.size() ? std::max(truncation[sample], rounding[sample])
                                      : std::numeric_limits<double>::infinity();
}

MotionSpec some_roundings_away(MotionSpec spec) {
    // a number errs by half an ulp at most; 12 ulps leave room for what the steps add
    Quad change = 12 * (spec.precision == Precision::in_quad ? std::numeric_limits<Quad>::epsilon()
                                                            : Quad(std::numeric_limits<double>::epsilon()));
    const auto move = [&](Quad& number) {
        number *= 1 + change;
        change = -change;
    };
    if (spec.chain) {
        for (auto* numbers : {&spec.chain->angle, &spec.chain->rate, &spec.chain->length, &spec.chain->mass})
            for (auto& number : *numbers) move(number);
        move(spec.chain->gravity);
    }
    if (spec.parts) {
        // places and velocities stay: constraints hold them
        for (auto& particle : spec.parts->particles) move(particle.mass);
        for (auto& force : spec.parts->forces) {
            if (auto* gravity = std::get_if<Gravity<Quad>>(&force)) move(gravity->g);
            if (auto* spring = std::get_if<Spring<Quad>>(&force)) move(spring->stiffness);
        }
    }
    return spec;
}

ErrorCourse error_course(const MotionSpec& spec, const MotionSpec& finer, long samples, double reach, double enough,
                         const std::atomic<bool>& stop) {
    const bool angles = spec.chain.has_value();
    const auto watched = [](MotionSpec of) {
        of.follows_turns = false;
        return make_motion(of);
    };
    const auto run = watched(spec), fine = watched(finer), moved = watched(some_roundings_away(spec));
    ErrorCourse course;
    double truncation = 0, rounding = 0;
    for (long sample = 0; sample <= samples; ++sample) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        try {
            if (sample > 0)
                for (const auto& motion : {&run, &fine, &moved}) (*motion)->advance(stop);
        } catch (const Error& fault) {
            if (fault.code() != ExitCode::method_failed) throw;
            course.failure = fault.what();
            break;
        }
        const auto seen = run->observe();
        const double apart = error_between(seen, fine->observe(), angles, reach),
                     shaken = error_between(seen, moved->observe(), angles, reach);
        if (!std::isfinite(apart) || !std::isfinite(shaken)) break;
        truncation = std::max(truncation, apart);
        rounding = std::max(rounding, shaken);
        course.truncation.push_back(truncation);
        course.rounding.push_back(rounding);
        course.effort = run->effort();
        if (std::max(truncation, rounding) > enough) break;
    }
    return course;
}

}  // namespace doppel

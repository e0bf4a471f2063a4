#pragma once

#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "physics/pendulums.hpp"

#include <gtest/gtest.h>

namespace doppel {

/// A chain with a fixed step of 1/rate s; one step per sample.
inline MotionSpec stepping(Model model, std::string_view method, const Pendulum<double>& p, long rate) {
    MotionSpec spec;
    spec.chain = p.cast<Quad>();
    spec.model = model;
    spec.method = method;
    spec.sample_interval = {1, rate};
    spec.steps_per_sample = 1;
    return spec;
}

/// Calls visit(model, method) for every method and each of the two models of chains that it supports.
template <class Visit>
void for_each_combination(const Visit& visit) {
    for (const auto& method : methods()) {
        SCOPED_TRACE(method.name);
        if (method.angles) visit(Model::angles, method);
        if (method.constraints) visit(Model::constraints, method);
    }
}

/// The motion of a spec, and its samples.
struct Course {
    std::unique_ptr<Motion> motion;
    std::atomic<bool> never = false;

    explicit Course(const MotionSpec& spec) : motion(make_motion(spec)) {}
    Observation observe() const { return motion->observe(); }
    Observation advance(long samples) {
        for (long i = 0; i < samples; ++i) motion->advance(never);
        return motion->observe();
    }
};

}  // namespace doppel

#pragma once

#include "integrate/methods.hpp"
#include "integrate/motion.hpp"
#include "integrate/registry.hpp"
#include "integrate/stabilise.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/physical_chain.hpp"
#include "physics/rod_chain.hpp"

namespace doppel {

// The stepper of a motion with its model, from the release. Throws Error (exit 2) if the method does not support the
// model. Compiled in separate files, in parallel.

template <class Scalar>
using MakeStepper = std::unique_ptr<Stepper<Scalar>>(const MotionSpec& spec);

template <class Scalar>
Scalar step_or_tolerance(const MotionSpec& spec) {
    return find_method(spec.method)->adaptive ? static_cast<Scalar>(spec.tolerance)
                                              : spec.sample_interval.as<Scalar>() / Scalar(spec.steps_per_sample);
}

/// With a model of `system`, constructed with `more`.
template <class Model, class System, class... More>
std::unique_ptr<Stepper<typename Model::Scalar>> stepper_on(const System& system, const MotionSpec& spec,
                                                            const More&... more) {
    using Scalar = typename Model::Scalar;
    return make_stepper(spec.method, Model(system, more...), Model::start(system), step_or_tolerance<Scalar>(spec));
}

/// RK4 of N bodies, for which the compiler unrolls the loops.
template <int N>
std::unique_ptr<Stepper<double>> rk4_of_bodies(const PhysicalPendulum<double>& p, const MotionSpec& spec) {
    using Model = PhysicalChain<double, N>;
    return std::make_unique<MethodStepper<Rk4, Model>>(std::make_unique<Model>(p), Model::start(p),
                                                       step_or_tolerance<double>(spec));
}

/// With a constrained model of `system`, stabilised as requested.
template <Constrained Model, class System>
std::unique_ptr<Stepper<typename Model::Scalar>> stepper_on_stabilised(const System& system, const MotionSpec& spec) {
    using Scalar = typename Model::Scalar;
    if (spec.stabilise == Stabilise::baumgarte)
        return stepper_on<Baumgarte<Model>>(system, spec, static_cast<Scalar>(spec.stabilise_rate));
    if (spec.stabilise == Stabilise::projection) return stepper_on<Projected<Model>>(system, spec);
    return stepper_on<Model>(system, spec);
}

/// Two links use the closed form; longer chains O(N). For three links in double, the compiler unrolls the loops for
/// methods that only need rates.
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_angles_stepper(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    if (spec.physical) {
        const auto bodies = spec.physical->cast<Scalar>();
        if constexpr (std::is_same_v<Scalar, double>)
            if (spec.method == Rk4::method.name) {
                if (p.links() == 2) return rk4_of_bodies<2>(bodies, spec);
                if (p.links() == 3) return rk4_of_bodies<3>(bodies, spec);
            }
        return stepper_on<PhysicalChain<Scalar>>(bodies, spec);
    }
    if (p.links() == 2) return stepper_on<DoublePendulum<Scalar>>(p, spec);
    if constexpr (std::is_same_v<Scalar, double>)
        if (p.links() == 3 && find_method(spec.method)->stabilised) return stepper_on<AngleChain<Scalar, 3>>(p, spec);
    return stepper_on<AngleChain<Scalar, Eigen::Dynamic>>(p, spec);
}

/// A chain of particles on rods. For two and three links in double, the compiler unrolls the loops for methods that
/// only need rates.
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_constraints_stepper(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    if constexpr (std::is_same_v<Scalar, double>)
        if (spec.stabilise == Stabilise::none) {
            const bool needs_rates = find_method(spec.method)->stabilised;
            if (p.links() == 2) return stepper_on<RodChain<Scalar, 2>>(p, spec);
            if (p.links() == 3 && needs_rates) return stepper_on<RodChain<Scalar, 3>>(p, spec);
        }
    return stepper_on_stabilised<RodChain<Scalar, Eigen::Dynamic>>(p, spec);
}

template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_mechanism_stepper(const MotionSpec& spec) {
    return stepper_on_stabilised<Mechanism<Scalar>>(spec.parts->cast<Scalar>(), spec);
}

}  // namespace doppel

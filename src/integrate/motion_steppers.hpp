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

// The method of a motion at work on its model, from the state released. Throw Error (exit 2) where it cannot step it.
// Compiled in files of their own, side by side.

template <class Scalar>
using MakeStepper = std::unique_ptr<Stepper<Scalar>>(const MotionSpec& spec);

template <class Model>
std::unique_ptr<Stepper<typename Model::Scalar>> stepper_on(const Model& model, const typename Model::State& start,
                                                            const MotionSpec& spec) {
    using Scalar = typename Model::Scalar;
    const Scalar step_or_tolerance = find_method(spec.method)->adaptive
                                         ? static_cast<Scalar>(spec.tolerance)
                                         : spec.sample_interval.as<Scalar>() / Scalar(spec.steps_per_sample);
    return make_stepper(spec.method, model, start, step_or_tolerance);
}

/// On a constrained model of `system`, stabilised as asked.
template <Constrained Model, class System>
std::unique_ptr<Stepper<typename Model::Scalar>> stepper_on_stabilised(const System& system, const MotionSpec& spec) {
    using Scalar = typename Model::Scalar;
    const auto start = Model::start(system);
    switch (spec.stabilise) {
        case Stabilise::baumgarte:
            return stepper_on(Baumgarte<Model>(system, static_cast<Scalar>(spec.stabilise_rate)), start, spec);
        case Stabilise::projection:
            return stepper_on(Projected<Model>(system), start, spec);
        case Stabilise::none:
            break;
    }
    return stepper_on(Model(system), start, spec);
}

/// Two links go by the closed form; chains by O(N), three of double unrolled by the compiler for methods that ask for no more
/// than rates.
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_angles_stepper(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    const auto made = [&]<class Model>(std::type_identity<Model>) {
        return stepper_on(Model(p), Model::start(p), spec);
    };
    if (spec.physical) {
        const auto physical = spec.physical->cast<Scalar>();
        return stepper_on(PhysicalChain<Scalar>(physical), PhysicalChain<Scalar>::start(physical), spec);
    }
    if (p.links() == 2) return made(std::type_identity<DoublePendulum<Scalar>>());
    if constexpr (std::is_same_v<Scalar, double>)
        if (p.links() == 3 && find_method(spec.method)->stabilised)
            return made(std::type_identity<AngleChain<Scalar, 3>>());
    return made(std::type_identity<AngleChain<Scalar, Eigen::Dynamic>>());
}

/// A chain of particles on rods: two and three links of double unrolled by the compiler for methods that ask for no more than
/// rates.
template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_constraints_stepper(const MotionSpec& spec) {
    const auto p = spec.chain->cast<Scalar>();
    if constexpr (std::is_same_v<Scalar, double>)
        if (spec.stabilise == Stabilise::none && find_method(spec.method)->stabilised) {
            if (p.links() == 2) return stepper_on(RodChain<Scalar, 2>(p), RodChain<Scalar, 2>::start(p), spec);
            if (p.links() == 3) return stepper_on(RodChain<Scalar, 3>(p), RodChain<Scalar, 3>::start(p), spec);
        }
    return stepper_on_stabilised<RodChain<Scalar, Eigen::Dynamic>>(p, spec);
}

template <class Scalar>
std::unique_ptr<Stepper<Scalar>> make_mechanism_stepper(const MotionSpec& spec) {
    return stepper_on_stabilised<Mechanism<Scalar>>(spec.parts->cast<Scalar>(), spec);
}

}  // namespace doppel

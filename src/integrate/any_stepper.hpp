#pragma once

#include "integrate/registry.hpp"

namespace doppel {

template <class State>
std::unique_ptr<Stepper<State>> make_any_stepper(std::string_view method, AnySystem<State> system, const State& start,
                                                 const typename State::Scalar& step_or_tolerance) {
    std::unique_ptr<Stepper<State>> stepper;
    for_each_method([&]<class Which>() {
        if constexpr (serves<Which, AnySystem<State>>)
            if (Which::method.name == method)
                stepper = std::make_unique<MethodStepper<Which, AnySystem<State>>>(std::move(system), start,
                                                                                   step_or_tolerance);
    });
    return stepper;
}

template <class State>
using MakeAnyStepper = std::unique_ptr<Stepper<State>>(std::string_view, AnySystem<State>, const State&,
                                                       const typename State::Scalar&);

}  // namespace doppel

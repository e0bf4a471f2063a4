#pragma once

#include "integrate/registry.hpp"

namespace doppel {

template <class State>
using MakeAnyStepper = std::unique_ptr<Stepper<typename State::Scalar>>(std::string_view, AnySystem<State>,
                                                                        const State&, const typename State::Scalar&);

template <class State>
std::unique_ptr<Stepper<typename State::Scalar>> make_any_stepper(std::string_view method, AnySystem<State> system,
                                                                  const State& start,
                                                                  const typename State::Scalar& step_or_tolerance) {
    std::unique_ptr<Stepper<typename State::Scalar>> stepper;
    for_each_method([&]<class Which>() {
        if constexpr (serves<Which, AnySystem<State>>)
            if (Which::method.name == method)
                stepper = std::make_unique<MethodStepper<Which, AnySystem<State>>>(std::move(system), start,
                                                                                   step_or_tolerance);
    });
    return stepper;
}

}  // namespace doppel

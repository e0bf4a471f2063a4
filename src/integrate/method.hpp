#pragma once

#include "physics/constrained.hpp"

#include <string_view>

namespace doppel {

/// A method as presets name it and people read it; every method's file holds its own.
struct Method {
    std::string_view name;        // value of `integrator`
    std::string_view title;       // in words
    int order;                    // its error shrinks like step^order; 0 = chosen from the tolerance
    bool adaptive;                // goes by `tolerance` in place of `step_s`
    std::string_view properties;  // "explicit", "implicit, symplectic, time-reversible"
};

/// Every method is a class template over the model, used like this; all its memory is allocated by the constructor:
///
///     fixed step   Stepper(Model&, const State& start, const Scalar& step);       advance(long steps)
///     adaptive     Stepper(Model&, const State& start, const Scalar& tolerance);  advance(const Scalar& seconds)
///     both         state() → State, now          evaluations() → long, of the right-hand side so far
///     adaptive     steps() → long, accepted      smallest_step() → Scalar, s, of the accepted ones that error control chose
///
/// Errors: Error (exit 3) where a step cannot be made: no convergence, a step size that vanishes, a tolerance that the
/// scalar cannot give.
/// The right-hand side, for methods of many stages: called, not copied into every one of them, which costs them two
/// nanoseconds a stage and saves minutes of compiling.
template <class Model, class State>
[[gnu::noinline]] void slope(Model& model, const State& y, State& dydt) {
    model.rate(y, dydt);
}

/// After every step a model may set the state right (projection onto its constraints): settle().
template <class Model, class State>
void settle(Model& model, State& y) {
    if constexpr (requires { model.settle(y); }) model.settle(y);
}

}  // namespace doppel

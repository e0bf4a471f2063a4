#pragma once

#include "integrate/method.hpp"

#include <memory>
#include <string_view>

namespace doppel {

/// A method at work on a system with states of one type, as what samples it drives it.
template <class Y>
class Stepper {
public:
    using State = Y;
    using Scalar = typename Y::Scalar;

    virtual ~Stepper() = default;
    virtual void advance(long steps) = 0;                // of a method with a fixed step
    virtual void advance_by(const Scalar& seconds) = 0;  // of an adaptive one
    virtual State state() const = 0;
    virtual long evaluations() const = 0;      // of the right-hand side
    virtual long steps() const = 0;            // of an adaptive method, accepted
    virtual Scalar smallest_step() const = 0;  // s, of those
};

/// The method of that name on any system; null where it wants to know more of one. Compiled for the states of Doppel's
/// models in stepper_double.cpp and motion_quad.cpp.
template <class State>
std::unique_ptr<Stepper<State>> make_any_stepper(std::string_view method, AnySystem<State> system, const State& start,
                                                 const typename State::Scalar& step_or_tolerance);

}  // namespace doppel

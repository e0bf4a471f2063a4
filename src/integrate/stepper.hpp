#pragma once

#include "integrate/method.hpp"

#include <memory>
#include <string_view>

namespace doppel {

/// A method at work on a system, as what samples it drives it.
template <class S>
class Stepper {
public:
    using Scalar = S;
    using State = doppel::State<Scalar, Eigen::Dynamic>;

    virtual ~Stepper() = default;
    virtual void advance(long steps) = 0;                // of a method with a fixed step
    virtual void advance_by(const Scalar& seconds) = 0;  // of an adaptive one
    virtual void read(State& y) const = 0;               // y ← the state now
    virtual long evaluations() const = 0;                // of the right-hand side
    virtual long steps() const = 0;                      // of an adaptive method, accepted
    virtual Scalar smallest_step() const = 0;            // s, of those

    State state() const {
        State y;
        read(y);
        return y;
    }
};

/// The method of that name on any system; null where it wants to know more of one. Compiled for the states of Doppel's
/// models in stepper_any_double.cpp and stepper_quad.cpp.
template <class State>
std::unique_ptr<Stepper<typename State::Scalar>> make_any_stepper(std::string_view method, AnySystem<State> system,
                                                                  const State& start,
                                                                  const typename State::Scalar& step_or_tolerance);

}  // namespace doppel

#pragma once

#include "integrate/runge_kutta.hpp"
#include "physics/mechanism.hpp"

namespace doppel {

template <class S>
using At = Place<S>;
using P = Place<double>;
/// Indices of particles, named as messages number them.
namespace counted {
inline constexpr std::size_t one = 0, two = 1, three = 2, four = 3;
}

/// The state after this number of rk4 steps.
template <class S>
State<S, Eigen::Dynamic> after(Mechanism<S>& model, const Assembly<S>& assembly, long steps, const S& step) {
    Rk4::Stepper<Mechanism<S>> stepper(model, model.start(assembly), step);
    stepper.advance(steps);
    return stepper.state();
}

/// A four-bar loop: two cranks of 1 and 1.5 m on anchored particles 2 m apart, and a coupler.
inline Assembly<double> four_bars() {
    using namespace counted;
    const P left(0.6, 0.8), right(2 + 0.9, 1.2);
    return {.particles = {{1, P(0, 0)}, {1, left}, {2, right}, {1, P(2, 0)}},
            .constraints = {Anchor<double>{one, P(0, 0)}, Rod<double>{two, one, 1}, Anchor<double>{four, P(2, 0)},
                            Rod<double>{three, four, 1.5}, Rod<double>{two, three, (right - left).norm()}},
            .forces = {Gravity<double>{}}};
}

/// A parallelogram of cranks of 1 m and a coupler of 2 m, which passes a position with all three aligned
/// after about 0.09 s.
/// There it could continue as a parallelogram or crossed, and the equations do not decide.
inline Assembly<double> parallelogram() {
    using namespace counted;
    return {.particles = {{1, P(0.6, -0.8), P(6.4, 4.8)}, {1.5, P(2.6, -0.8), P(6.4, 4.8)}},
            .constraints = {Rod<double>{one, P(0, 0), 1}, Rod<double>{two, P(2, 0), 1}, Rod<double>{one, two, 2}},
            .forces = {Gravity<double>{}}};
}

}  // namespace doppel

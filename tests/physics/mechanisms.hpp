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

/// Springs with damping, attraction, a near droplet, straight and circular slots, and a loop.
inline Assembly<double> of_everything() {
    using namespace counted;
    auto parts = four_bars();
    parts.particles.push_back({0.7, P(3.5, 2)});
    parts.particles.push_back({0.4, P(-1, 2), P(-1, 0.5)});
    parts.constraints.push_back(SlotCircle<double>{5 - 1, P(3.5, 1), 1});
    parts.constraints.push_back(SlotLine<double>{6 - 1, P(-1, 2), P(2, -1)});
    parts.forces.push_back(Spring<double>{two, P(0, 2), 15, 0.5, 0.4});
    parts.forces.push_back(Spring<double>{5 - 1, three, 9, 1});
    parts.forces.push_back(Spring<double>{6 - 1, two, 4, 1.5, 0.1});
    parts.forces.push_back(Attraction<double>{6 - 1, two, 1.5});
    parts.forces.push_back(Droplet<double>{P(1, 3), 2, 3});
    return parts;
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

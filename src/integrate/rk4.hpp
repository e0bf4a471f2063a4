#pragma once

#include "integrate/runge_kutta.hpp"

namespace doppel {

/// Kutta 1901; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.1.2.
struct Rk4 {
    static constexpr Method method{"rk4", "Runge–Kutta 4", 4, false, "explicit"};
    static constexpr Tableau<4> table{.a = {{{}, {{{1, 2}}}, {{{0, 1}, {1, 2}}}, {{{0, 1}, {0, 1}, {1, 1}}}}},
                                      .b = {{{1, 6}, {1, 3}, {1, 3}, {1, 6}}}};
    template <System Model>
    using Stepper = RungeKutta<Model, table>;
};

}  // namespace doppel

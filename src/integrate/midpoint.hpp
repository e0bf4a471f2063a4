#pragma once

#include "integrate/runge_kutta.hpp"

namespace doppel {

/// Runge 1895; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, eq. II.1.4.
struct Midpoint {
    static constexpr Method method{"midpoint", "explicit midpoint", 2, false, "explicit"};
    static constexpr Tableau<2> table{.a = {{{}, {{{1, 2}}}}}, .b = {{{0, 1}, {1, 1}}}};
    template <System Model>
    using Stepper = RungeKutta<Model, table>;
};

}  // namespace doppel

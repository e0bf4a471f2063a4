#pragma once

#include "integrate/tableau.hpp"

namespace doppel {

/// Kutta 1901; Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.1.2.
inline constexpr Tableau<4> rk4{.name = "rk4",
                                .title = "Runge–Kutta 4",
                                .order = 4,
                                .a = {{{}, {{{1, 2}}}, {{{0, 1}, {1, 2}}}, {{{0, 1}, {0, 1}, {1, 1}}}}},
                                .b = {{{1, 6}, {1, 3}, {1, 3}, {1, 6}}}};

}  // namespace doppel

#pragma once

#include "integrate/tableau.hpp"

namespace doppel {

/// Euler 1768: positions advance with the old velocities, velocities with the old forces.
inline constexpr Tableau<1> euler{.name = "euler", .title = "explicit Euler", .order = 1, .a = {}, .b = {{{1, 1}}}};

}  // namespace doppel

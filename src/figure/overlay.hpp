#pragma once

#include "plot/plot.hpp"
#include "scene/field.hpp"
#include "scene/preset.hpp"

#include <array>
#include <vector>

namespace doppel {

/// Theoretical curves on a map.
enum class Overlay { none, kapitza, mathieu, energy_bound, linear_limit };
template <>
inline constexpr auto names_of<Overlay> = std::to_array<std::string_view>({"none", "kapitza", "mathieu", "energy-bound",
                                                                           "linear-limit"});

/// `kapitza`, `mathieu`: where a vertically oscillating pivot stabilises one link upright, and where it destabilises
/// it. The curves are the amplitude a, m, over the frequency, Hz. With l = J/(m c) the length of the equivalent simple
/// pendulum, and ν = 2π f:
///     Kapitza    a² ν² = 2 g l ,    for a much less than l
///     Mathieu    −4 g / (l ν²) = a₀(q) and b₁(q) ,   q = 2 a / l ,
/// from the power series of the characteristic values, accurate to 1e-3 for q ≤ 1.2.
/// `energy_bound`: where a double pendulum released at rest has just enough energy for a flip: θ2 over θ1, degrees,
/// with
///     Σ W_i cosθ_i = Σ W_i − 2 min W_i    (integrate/flips.hpp).
/// `linear_limit`: for each panel, the step size at which small oscillations diverge in linear theory
/// (analysis/stability.hpp); it depends on the grid, which draws it.
/// Source  Landau & Lifshitz, Mechanics, §30; Abramowitz & Stegun, 20.2.25.
std::vector<Curve> overlay_curves(Overlay overlay, const SideSpec& side);

}  // namespace doppel

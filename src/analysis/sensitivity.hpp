#pragma once

#include "physics/pendulum.hpp"

#include <atomic>

namespace doppel {

/// How much a motion makes of an error at its start: the largest |∂θ_i(T)/∂θ_j(0)|, from the tangent equations in dual
/// numbers. Times the rounding of a double, 2⁻⁵³, it is the error that no method in double can be expected to beat.
/// Throws Error: exit 3 where a step cannot be made, exit 130 soon after `stop` is set.
double angle_sensitivity(const Pendulum<double>& p, double seconds, const std::atomic<bool>& stop);

}  // namespace doppel

#pragma once

#include "integrate/motion.hpp"

#include <Eigen/Core>

#include <span>
#include <string_view>

namespace doppel {

/// The factor by which `steps` steps of a fixed-step method multiply the energy of a linear oscillator, with
/// z = angular frequency · step > 0:
///     euler, midpoint, rk4: |Σ_{k ≤ order} (iz)ᵏ / k!|² per step: (1 + z²), (1 + z⁴/4), (1 − z⁶/72 + z⁸/576) ,
///     semi-implicit-euler, rattle, rattle6: the square of their spectral radius, 1 up to z = 2, rattle6 to 2.53 ,
///     adams: from the exact solution at the start, because its growing roots start small ,
///     gauss4 and gauss6: 1, stable at every z (the iteration for their stages is not).
/// Source  Hairer & Wanner, Solving Ordinary Differential Equations II, §IV.2 and §V.1.
double energy_growth(std::string_view method, double z, long steps);

/// A normal mode of a chain that hangs straight down.
struct Mode {
    double frequency;  // rad/s
    double share = 1;  // fraction of the release's energy
};

/// All modes, the slowest first. If the release has no energy, the fastest mode gets all of it. Gravity must be > 0. In
/// the displacements of the masses across the rods, times √m_k, they are those of masses on a string, with
///     κ_i = g Σ_{j≥i} m_j / l_i ,   diagonal (κ_i + κ_{i+1}) / m_i ,   off-diagonal −κ_{i+1} / √(m_i m_{i+1}) .
std::vector<Mode> small_oscillations(const Pendulum<double>& pendulum);

/// The smallest step size, s, at which the energy of the release grows `times`-fold within `seconds` in linear theory:
///     Σ_i share_i energy_growth(frequency_i · step, seconds / step) ≥ times .
/// For a method that is stable below some z, this is above that limit, and closer to it for longer times. Euler and
/// midpoint, which are never stable, have such a step, too. Nothing if no step size up to `seconds` reaches it.
std::optional<double> step_limit(std::string_view method, std::span<const Mode> modes, double seconds, double times);

/// The largest real part of a matrix's eigenvalues; 0 if it is zero within rounding.
double largest_real_part(const Eigen::MatrixXd& matrix);

/// Energies are compared with the release's energy above the hanging equilibrium. A larger relative error is a failure.
inline constexpr double failure_error = 100;

/// The largest energy error at the first samples of a motion like `spec`, for each release, relative to the released
/// energy. NaN for a failed run: an error above `failure_error`, NaN, or a step that cannot be made. All releases must
/// have the same number of links. Throws Error: exit 2 if the method does not support the model, exit 130 soon after
/// `stop` is set.
std::vector<double> max_energy_errors(MotionSpec spec, std::span<const Pendulum<Quad>> releases, long samples,
                                      const std::atomic<bool>& stop);

}  // namespace doppel

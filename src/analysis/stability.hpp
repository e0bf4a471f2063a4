#pragma once

#include "integrate/motion.hpp"

#include <span>
#include <string_view>

namespace doppel {

/// What so many steps of a method of fixed step multiply the energy of a linear oscillator by, with z = angular
/// frequency · step > 0:
///     euler, midpoint, rk4 |Σ_{k ≤ order} (iz)ᵏ / k!|² a step: (1 + z²), (1 + z⁴/4), (1 − z⁶/72 + z⁸/576) ,
///     semi-implicit-euler, rattle, rattle6 the square of their spectral radius: 1 up to z = 2, that of rattle6 2.53 ,
///     adams, whose growing roots begin small, what its steps make of the true motion ,
///     gauss4 and gauss6 1: they are stable at every z (the iteration for their stages is not).
/// Source  Hairer & Wanner, Solving Ordinary Differential Equations II, §IV.2 and §V.1.
double energy_growth(std::string_view method, double z, long steps);

/// One of a chain's small oscillations about hanging straight down.
struct Mode {
    double frequency;  // rad/s
    double share = 1;  // of the energy of the release
};

/// All of them, slowest first. Where the release has no energy, the fastest has it all. Gravity must be > 0. In the
/// displacements of the masses across the rods, times √m_k, they are those of masses on a string, with
///     κ_i = g Σ_{j≥i} m_j / l_i ,   diagonal (κ_i + κ_{i+1}) / m_i ,   off it −κ_{i+1} / √(m_i m_{i+1}) .
std::vector<Mode> small_oscillations(const Pendulum<double>& pendulum);

/// The least step, s, at which linear theory has the energy of the release grow `times` within `seconds`:
///     Σ_i share_i energy_growth(frequency_i · step, seconds / step) ≥ times .
/// For a method that is stable below some z this is above it, the closer the longer the time; Euler and midpoint, stable
/// nowhere, have that step too. Nothing where no step up to `seconds` does it.
std::optional<double> step_limit(std::string_view method, std::span<const Mode> modes, double seconds, double times);

/// Energy is compared with what a release has above hanging at rest. An error beyond so many times counts as a failure.
inline constexpr double failure_error = 100;

/// The energy of a release above hanging at rest, J.
double released_energy(const Pendulum<double>& release);

/// The greatest error of the energy at the first samples of a motion as `spec` has it of another chain, for each release: of
/// the energy released; not a number for a failed run: an error beyond `failure_error`, NaN, or a method that gives up.
/// The releases have the same number of links. Throws Error: exit 2 where the method does not serve the model, exit 130
/// soon after `stop` is set.
std::vector<double> greatest_energy_errors(MotionSpec spec, std::span<const Pendulum<Quad>> releases, long samples,
                                           const std::atomic<bool>& stop);

}  // namespace doppel

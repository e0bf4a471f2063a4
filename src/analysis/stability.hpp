#pragma once

#include "integrate/motion.hpp"
#include "numeric/rational.hpp"
#include "physics/physical_pendulum.hpp"

#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// What a method of fixed step multiplies the amplitude of a linear oscillator by at every step, with z = angular
/// frequency · step > 0: the spectral radius of the step, in closed form where there is one. Energy grows by its
/// square.
///     euler √(1 + z²) ,  midpoint √(1 + z⁴/4) ,  rk4 √(1 − z⁶/72 + z⁸/576) ,
///     semi-implicit-euler and rattle 1 up to z = 2, then z²/2 − 1 + √((z²/2 − 1)² − 1) ,
///     gauss4 and gauss6 1: they are stable at every z (the iteration for their stages is not).
/// Throws Error (exit 2) where the method has no fixed step, or there is none of that name.
/// Source  Hairer & Wanner, Solving Ordinary Differential Equations II, §IV.2 and §V.1.
double growth(std::string_view method, double z);

/// One of a chain's small oscillations about hanging straight down.
struct Mode {
    double frequency;  // rad/s
    double share = 1;  // of the energy of the release
};

/// All of them, slowest first. Where the release has no energy, the fastest has it all. Gravity must be > 0.
///     M_ij = l_i l_j Σ_{k ≥ i, j} m_k ,  K_ii = g l_i Σ_{k ≥ i} m_k ,  K v = ω² M v
std::vector<Mode> small_oscillations(const Pendulum<double>& pendulum);

/// Of the fastest one, rad/s: √(2 + √2) √(g/l) for two equal links.
double largest_frequency(const Pendulum<double>& pendulum);

/// The least step, s, at which linear theory has the energy of the release grow `times` within `seconds`:
///     Σ_i share_i growth(frequency_i · step)^(2 seconds / step) ≥ times ,
/// of adams, whose growing roots begin small, what its steps make of the true motion. For a method that is stable below
/// some z this is above it, the closer the longer the time; Euler and midpoint, stable nowhere, have that step too.
/// Nothing where no step up to `seconds` does it.
std::optional<double> step_limit(std::string_view method, std::span<const Mode> modes, double seconds, double times);

/// The Lyapunov exponent in closed form, 1/s, where the release is an equilibrium: at rest and all links upright or
/// hanging to rounding (or g = 0). Nothing elsewhere, as of what is driven.
/// Of a physical one it is the greatest real part of the eigenvalues of the linearised equations; no Coulomb's friction.
std::optional<double> equilibrium_exponent(const Pendulum<double>& p);
std::optional<double> equilibrium_exponent(const PhysicalPendulum<double>& p);

/// Energy is compared with what a release has above hanging at rest. An error beyond so many times that is a blow-up.
inline constexpr double blow_up = 100;

/// How pendulums are stepped, and how often their energy is sampled.
struct StabilityRun {
    std::string method;
    Model model = Model::angles;
    Rational duration{10, 1};   // s
    long samples = 100;         // of the energy, evenly over the duration
    long steps_per_sample = 1;  // of methods with a fixed step
    Quad tolerance = 0;         // of adaptive ones
    int width = 0;              // doubles to a register (integrate/batch.hpp); changes no bit

    /// s
    double step() const { return duration.value() / static_cast<double>(samples * steps_per_sample); }
};

/// The energy of a release above hanging at rest, J.
double released_energy(const Pendulum<double>& release);

/// The greatest error of the energy within the run, of the energy released, for each release; not a number for a
/// blow-up, which ends its run: an error beyond `blow_up`, NaN, or a method that gives up.
/// The releases have the same number of links. Throws Error: exit 2 where the method does not serve the model, exit 130
/// soon after `stop` is set.
std::vector<double> greatest_energy_errors(const StabilityRun& run, std::span<const Pendulum<Quad>> releases,
                                           const std::atomic<bool>& stop);

}  // namespace doppel

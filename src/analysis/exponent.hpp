#pragma once

#include "physics/physical_pendulum.hpp"

#include <atomic>
#include <vector>

namespace doppel {

/// Natural units of a pendulum's motion: the mean link length, and a typical time.
struct NaturalUnits {
    double length;  // m
    double time;    // s: 1 / √(g/l) or 1 / the largest initial rate, whichever is less; 1 if nothing moves

    /// A drive counts like gravity, by the largest acceleration of the pivot, and that of all masses by the joint
    /// torques.
    explicit NaturalUnits(const PhysicalPendulum<double>& p);
};

struct ExponentSpec {
    double duration_s = 500;               // of the motion, including the transient; > 0
    double transient_s = duration_s / 10;  // left out at the start, while the tangent aligns
    double tolerance = 1e-7;  // of dop853 for state and tangent; the energy error after 500 s is 3e-7 of its range
};

/// The largest Lyapunov exponent, λ = lim ln|δ(t)|/t.
struct Exponent {
    double value;  // 1/s
    /// 1/s. The value of a run four times as long from a nearby release is within this in two of three cases. It is
    /// within twice this in nine of ten (docs/methods.md has the frequencies).
    double uncertainty;
    /// Whether long parts of the run differ no more than short parts suggest. If they differ more (a chaotic transient,
    /// sticky orbits), one run does not represent the whole motion, and the uncertainty is too small.
    bool is_settled = true;

    /// Whether the release is an equilibrium, whose exponent is exact.
    bool is_of_equilibrium() const { return uncertainty == 0; }
};

/// Whether the exponent cannot be distinguished from 0, as for regular motion: up to 1.5 times its uncertainty (40
/// regular motions had at most 0.8).
inline bool is_regular(const Exponent& exponent) {
    return exponent.value <= 1.5 * exponent.uncertainty;
}

/// The largest exponent of the motion released as `p`, with any number of links, from the tangent equations in (θ, ω).
/// The time of a driven pendulum is given, so it has no exponent of its own.
/// A release at an equilibrium (at rest with all links vertical within rounding, or g = 0) stays there: its exponent is
/// the largest real part of the eigenvalues of the linearised equations.
/// Source  Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15:21.
/// Errors  exit 2 if joints have Coulomb friction, exit 3 if dop853 fails, exit 130 soon after `stop` is set.
Exponent largest_exponent(const Pendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop);
Exponent largest_exponent(const PhysicalPendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop);

struct SpectrumSpec {
    double duration_s = 500;   // of the motion; > 0
    int samples = 500;         // at least one; equally spaced, the last at the end
    double tolerance = 1e-10;  // of dop853, for the state and its tangents
};

/// The estimates of the exponents at a time.
struct SpectrumSample {
    double time_s;
    std::vector<double> exponents;  // 1/s, 2N of them; for large times in descending order
};

/// Estimates of all 2N Lyapunov exponents of a chain of 1 to 4 links, in the canonical variables (θ, p). At any time
/// their sum is 0 without friction; with friction it is the mean rate of change of volume, for viscous friction
/// −tr(C M⁻¹).
/// Errors  exit 2 for more links or Coulomb friction, exit 3 if the method fails, exit 130 soon after `stop` is set.
std::vector<SpectrumSample> lyapunov_spectrum(const PhysicalPendulum<double>& p, const SpectrumSpec& spec,
                                              const std::atomic<bool>& stop);

/// The largest |λ_i + λ_{2N+1−i}|, 1/s. It is 0 for a Hamiltonian system (no friction) in the limit, not at finite
/// time.
double pair_mismatch(const SpectrumSample& sample);

}  // namespace doppel

#pragma once

#include "physics/pendulum.hpp"

#include <atomic>
#include <vector>

namespace doppel {

struct SectionSpec {
    int crossings = 400;       // wanted, at least one
    double longest_s = 10000;  // of the motion: an orbit that never comes back ends here, with fewer
    double tolerance = 1e-13;  // of taylor
};

/// A double pendulum as its upper link passes the downward vertical counter-clockwise: θ1 = 0 (mod 2π), ω1 > 0.
/// At one energy (θ2, p2) tells the whole state, and the map from one crossing to the next keeps areas in it.
struct SectionPoint {
    double theta2;  // rad, in (−π, π]
    double p2;      // N m s, ∂L/∂ω2
    double p1;      // N m s; follows from the energy
    double time_s;
};

/// The crossings of the motion that a double pendulum `p` is released into, the release left out, to rounding. All of
/// them: on each step of taylor, the roots of the polynomial that its series makes of θ1 (numeric/roots.hpp), none
/// beyond the step. Only where θ1 passes and is back within 1e-15 of a step, a crossing may not be seen.
/// Errors  exit 3 where taylor fails, exit 130 soon after `stop` is set.
std::vector<SectionPoint> poincare_section(const Pendulum<double>& p, const SectionSpec& spec,
                                           const std::atomic<bool>& stop);

/// `count` releases of the double pendulum `p` on the section, spread over all of it that `energy_J` (above that of
/// hanging at rest) reaches. Masses, lengths and gravity are those of `p`. Throws Error (exit 2) for no energy.
std::vector<Pendulum<double>> releases_of_energy(const Pendulum<double>& p, double energy_J, int count);

}  // namespace doppel

#pragma once

#include "physics/pendulum.hpp"

#include <atomic>
#include <vector>

namespace doppel {

struct SectionSpec {
    int crossings = 400;       // number required, at least one
    double longest_s = 10000;  // limit of the motion; an orbit that never returns ends here, with fewer crossings
    double tolerance = 1e-13;  // of the Taylor method
};

/// The state of a double pendulum when its upper link passes the downward vertical counter-clockwise: θ1 = 0 (mod 2π),
/// ω1 > 0. At fixed energy (θ2, p2) determines the state, and the map from one crossing to the next preserves area.
struct SectionPoint {
    double theta2;  // rad, in (−π, π]
    double p2;      // N m s, ∂L/∂ω2
    double p1;      // N m s; follows from the energy
    double time_s;
};

/// The crossings of the motion of a double pendulum released as `p`, without the release itself, to rounding. On each
/// step of the Taylor method they are the roots of the series of θ1 (numeric/roots.hpp), so that none is missed. Only
/// if θ1 passes and returns within 1e-15 of a step, a crossing may be missed.
/// Errors  exit 3 if the Taylor method fails, exit 130 soon after `stop` is set.
std::vector<SectionPoint> poincare_section(const Pendulum<double>& p, const SectionSpec& spec,
                                           const std::atomic<bool>& stop);

/// `count` releases of the double pendulum `p` on the section, spread over the region that is accessible at `energy_J`
/// (above the hanging equilibrium). Masses, lengths and gravity are those of `p`. Throws Error (exit 2) for an energy
/// that is not > 0.
std::vector<Pendulum<double>> releases_of_energy(const Pendulum<double>& p, double energy_J, int count);

}  // namespace doppel

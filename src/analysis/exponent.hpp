#pragma once

#include "physics/physical_pendulum.hpp"

#include <atomic>

namespace doppel {

struct ExponentSpec {
    double duration_s = 500;               // of the motion, the transient included; > 0
    double transient_s = duration_s / 10;  // left out at the start, while the tangent finds its direction
    double tolerance = 1e-7;  // of dop853, state and tangent alike; energy keeps to 3e-7 of its range over 500 s
};

/// The largest Lyapunov exponent, λ = lim ln|δ(t)|/t.
struct Exponent {
    double value;  // 1/s
    /// 1/s: within it of the value is, two times in three or more, that of a run four times as long from a release next
    /// to this one; within twice of it nine times in ten or more (docs/methods.md has how often).
    double uncertainty;
    /// Whether long stretches of the run differ by no more than short ones foretell. Where they do (a chaotic transient,
    /// orbits that stick), one run does not show all of the motion, and the uncertainty is too small.
    bool is_settled = true;

    /// Whether the release stays where it is, and its exponent is known exactly.
    bool is_of_equilibrium() const { return uncertainty == 0; }
};

/// Whether the exponent cannot be told from 0, as for regular motion: up to 1.5 times its uncertainty (regular
/// motions had up to 0.8, of 40).
inline bool is_regular(const Exponent& exponent) {
    return exponent.value <= 1.5 * exponent.uncertainty;
}

/// The largest exponent of the motion that `p` is released into, any number of links, by the tangent equations in
/// (θ, ω). The time, by which a driven pendulum moves, is given: no exponent is its own.
/// One released at an equilibrium, at rest and all links upright or hanging to rounding (or g = 0), stays there: its
/// exponent is the greatest real part of the eigenvalues of the linearised equations.
/// Source  Benettin, Galgani, Giorgilli & Strelcyn 1980, Meccanica 15:21.
/// Errors  exit 2 where joints have Coulomb friction (require_smooth()), exit 3 where dop853 fails, exit 130 soon
///         after `stop` is set.
Exponent largest_exponent(const Pendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop);
Exponent largest_exponent(const PhysicalPendulum<double>& p, const ExponentSpec& spec, const std::atomic<bool>& stop);

/// Throws Error (exit 2) where joints have Coulomb friction: they come to rest and let go again, where the motion has no
/// tangents.
void require_smooth(const PhysicalPendulum<double>& p);

}  // namespace doppel

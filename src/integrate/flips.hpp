#pragma once

#include "physics/pendulum.hpp"

#include <atomic>
#include <span>

namespace doppel {

/// How far and how well pendulums are followed to their first flip.
struct FlipSpec {
    double duration = 20;     // s
    double tolerance = 1e-8;  // rad/s, what the last terms of a step may amount to
};

/// A tolerance that serves for so long a time: 1e-8 up to 20 s, and a tenth of it for every 2 s more, as chaos
/// multiplies the errors of steps; 1e-14 at the finest. Of the flips in 20–25 and 25–30 s, 1 in 57 and 3 in 40 are off
/// by more than 0.01 s at 1e-8, and none at 1e-11.
double flip_tolerance(double duration);

/// When each double pendulum first flips, s: one of its rods passes the upward vertical, |θ_i| > π. Infinity where none
/// does within the duration; 0 where it is released beyond; NaN where no step of 1e-9 s meets the tolerance. Those whose
/// energy forbids it are not integrated at all.
///
/// By Taylor series of order 16 in SIMD lanes, each with a step of its own and taking the next release as soon as its
/// own is done. Time i depends on pendulum i alone, to the last bit: not on the width, the order or the grouping; and
/// the mirror image (−θ1, −θ2, −ω1, −ω2) flips at the same time.
///
/// Accuracy at 1e-8, over 10 000 releases of the whole square (rest, 1 m, 1 kg), against TaylorStepper at 1e-13:
/// 99.98 % within 0.01 s. Chaos multiplies the error of a step: of the flips in 0–5, 5–10, 10–20 s, half are within 6e-11,
/// 6e-9, 2e-7 s, and 99 % within 2e-8, 3e-6, 4e-3 s. At 1e-6 it is 99.5 %, of those after 10 s 90 %. For the same share
/// RK4 and DOP853 in the same lanes, at fixed steps, need some 2 to 8 times as long.
///
/// `pendulums`  as they are released, of two links each
/// `times`      as many
/// `width`      doubles to a register: one of register_widths(), or 0 for the widest
/// Errors      Error (exit 2) for other than two links, spans that differ in size, a duration that is not positive and
///             finite, a tolerance below 1e-15, or a width that this processor has not; exit 130 soon after `stop` is
///             set.
void first_flips(std::span<const Pendulum<double>> pendulums, const FlipSpec& spec, std::span<double> times,
                 const std::atomic<bool>& stop, int width = 0);

/// The same for one pendulum by other equations and means, some eight times slower, for the error of first_flips():
/// TaylorStepper with its tolerance. At 1e-13, of 110 flips within 20 s none is further than 2e-6 s from the same in
/// quad at 1e-24.
double reference_flip(const Pendulum<double>& pendulum, double duration, double tolerance);

/// Whether the pendulum has too little energy for any flip: less than the potential energy with its lightest rod
/// upright and all others hanging. With W_i = g l_i Σ_{k≥i} m_k that is −Σ W_j + 2 min W_i. Any number of links.
bool flip_is_forbidden(const Pendulum<double>& pendulum);

}  // namespace doppel

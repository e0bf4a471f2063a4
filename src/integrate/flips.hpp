#pragma once

#include "physics/pendulum.hpp"

#include <atomic>
#include <span>

namespace doppel {

/// The duration and accuracy for finding first flips.
struct FlipSpec {
    double duration = 20;     // s
    double tolerance = 1e-8;  // rad/s, for the last terms of the series in a step
};

/// A suitable tolerance for a duration: 1e-8 up to 20 s, and a tenth of it for every 2 s more, because chaos amplifies
/// the errors of steps; 1e-14 at the finest. For flips in 20–25 and 25–30 s, the error exceeds 0.01 s for 1 in 57 and 3
/// in 40 at 1e-8, and for none at 1e-11.
double flip_tolerance(double duration);

/// The time, s, of the first flip of each double pendulum: one of its rods passes the upward vertical, |θ_i| > π.
/// Infinity if none flips within the duration; 0 if a rod is released beyond π; NaN if even a step of 1e-9 s exceeds
/// the tolerance. Pendulums with too little energy for a flip are not integrated.
///
/// The method is Taylor series of order 16 in SIMD lanes. Each lane has its own step size, and takes the next release
/// when its own is finished. Time i depends only on pendulum i, to the last bit, and not on width, order or grouping.
/// The mirror image (−θ1, −θ2, −ω1, −ω2) flips at the same time.
///
/// Accuracy at 1e-8, over 10 000 releases of the whole square (rest, 1 m, 1 kg), compared with TaylorStepper at 1e-13:
/// 99.98 % within 0.01 s. Chaos amplifies the error of a step: for flips in 0–5, 5–10, 10–20 s, half are within 6e-11,
/// 6e-9, 2e-7 s, and 99 % within 2e-8, 3e-6, 4e-3 s. At 1e-6 it is 99.5 %; for those after 10 s, 90 %. For the same
/// share, RK4 and DOP853 in the same lanes at fixed steps take some 2 to 8 times as long.
///
/// `pendulums`  with their release, two links each
/// `times`      the results, of the same size
/// `width`      doubles per register: one of register_widths(), or 0 for the widest
/// Errors      exit 2 for other than two links, spans of different size, a duration that is not positive and finite, a
///             tolerance below 1e-15, or a width that this processor lacks; exit 130 soon after `stop` is set.
void first_flips(std::span<const Pendulum<double>> pendulums, const FlipSpec& spec, std::span<double> times,
                 const std::atomic<bool>& stop, int width = 0);

/// Whether the energy is too small for any flip: less than the potential energy with the lightest rod upright and all
/// others hanging. With W_i = g l_i Σ_{k≥i} m_k this is −Σ W_j + 2 min W_i. For any number of links.
bool flip_is_forbidden(const Pendulum<double>& pendulum);

}  // namespace doppel

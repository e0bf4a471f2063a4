#pragma once

#include "integrate/flip_series.hpp"
#include "integrate/flips.hpp"

#include <cstddef>

namespace doppel {

// What integrate/flips.cpp and the code for one kind of processor (integrate/flips_width.cpp) share, by the rules of
// integrate/batch_width.cpp.

struct FlipRequest {
    FlipChain chain;
    double omega[2];  // rad/s, at the release
    double duration;  // s
    double allowed;   // log2 of the tolerance, rad/s
    double longest;   // s, of a step
    std::size_t count;
    const Release* releases;
    double* times;  // s; those that are negative are to be found
    const std::atomic<bool>* stop;
};

enum class FlipOutcome { found, stopped, broken };

/// In the code for registers of `width` doubles (cmake/widths.cmake).
template <int width>
FlipOutcome find_flips(const FlipRequest& request);
template <>
FlipOutcome find_flips<2>(const FlipRequest& request);
template <>
FlipOutcome find_flips<4>(const FlipRequest& request);
template <>
FlipOutcome find_flips<8>(const FlipRequest& request);

/// The motion of one rod on one step of length h, s: the coefficients of its angle and of its rate, and where it ends.
struct RodOnStep {
    double h, theta[flip_order + 1], omega[flip_order + 1], theta_end;
};
/// When |θ| first exceeds π, s after the start of the step; infinity where it does not.
double first_flip(const RodOnStep& rod);

}  // namespace doppel

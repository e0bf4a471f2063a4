#pragma once

#include "integrate/flip_series.hpp"
#include "integrate/flips.hpp"

#include <cstddef>

namespace doppel {

// What passes between integrate/flips.cpp and the code that was compiled for one kind of processor
// (integrate/flips_width.cpp): plain numbers, as for ensembles.

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

}  // namespace doppel

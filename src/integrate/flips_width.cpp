// Compiled once for every kind of processor, as integrate/ensemble_width.cpp is and by the same rules.

#include "integrate/flip_lanes.hpp"

#ifndef DOPPEL_FLIPS_WIDTH
#define DOPPEL_FLIPS_WIDTH 2
#endif

namespace doppel {
namespace {

constexpr int width = DOPPEL_FLIPS_WIDTH;

struct ThisBuild;

}  // namespace

template <>
FlipOutcome find_flips<width>(const FlipRequest& request) {
    return FlipLanes<Lanes<width, ThisBuild>>(request).run();
}

}  // namespace doppel

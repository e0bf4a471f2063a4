#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// What would have held where `fault` broke down, in words: with a fixed step, the first of its halves, quarters … that
/// comes as far; of an adaptive method, the smallest step that it took. Gives up early where `stop` is set.
std::string step_that_holds(const Scene& scene, const BreakDown& fault, const std::atomic<bool>& stop);

}  // namespace doppel

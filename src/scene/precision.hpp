#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// Throws Error (exit 2) where what sets the sides apart is lost in double: two numbers that differ and round to the
/// same, or a droplet whose pull vanishes next to gravity.
void check_precision(const Scene& scene);

}  // namespace doppel

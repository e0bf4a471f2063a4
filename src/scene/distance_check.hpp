#pragma once

#include "scene/scene.hpp"

namespace doppel {

/// Throws Error where the sides are so far apart that their distance is out of the range of a double; it names the
/// number that makes it so. Exit 2 at the start, exit 3 later.
void check_distance(const Scene& scene, const Moment& moment);

}  // namespace doppel

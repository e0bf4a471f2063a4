#pragma once

#include "image/color.hpp"

namespace doppel {

/// The colour of `share` (0…1, beyond: the nearest end) of a scale: dark violet through blue and green to pale yellow.
///
/// Equal shares look equally far apart: the scale runs through OKLab (Ottosson 2020) at constant speed, and lightness
/// only grows, so that it holds in grey and for the colour-blind. Not a number: the lower end.
Color map_color(double share);

}  // namespace doppel

#pragma once

#include "plot/plot.hpp"
#include "plot/style.hpp"

namespace doppel {

// Parts of a chart that are cheaper, or only possible, pixel by pixel: images for the pixels that `scale` makes of each
// px.

/// Discs around many points, which do not add up where they overlap; cut off at the edges of `area`.
Image scatter_image(const std::vector<Point>& points, float radius, Color color, const Area& area, float scale);

/// The area between low[i] and high[i] over x[i], px; where one is not a number there is a gap.
struct Band {
    std::vector<double> x, low, high;
};
Image band_image(const Band& band, Color color, const Area& area, float scale);

}  // namespace doppel

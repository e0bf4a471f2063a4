#pragma once

#include "film/layout.hpp"
#include "image/color.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A curve's value at one time; named if the strip has several curves.
struct StripCurve {
    std::optional<double> value;
    Color color;
    double width = 0;  // px
    std::string name{};
};

/// The values that a strip shows. Potential energy is zero at the lowest point that a chain can reach. The energy of a
/// driven side is its mean over the last drive period. `style`: for colours and widths.
std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Style& style = {});

/// What it shows, with its unit: the beginning of its caption.
std::string title_of(StripKind kind, const Scene& scene);

/// ln(d/d0) / t, 1/s. Nothing in the first twentieth of the scene, where it is not meaningful yet, or if a distance is
/// 0.
std::optional<double> growth_rate(const Scene& scene, const PairState& state, double start_distance);

/// Line spacing of captions, px; also the distance from the last line to the curves.
float caption_line(const Layout& layout);
float above_curves(const Layout& layout);

/// The caption of a strip, as far as it has space: the quantity, and its value (one curve) or the curves' names.
std::vector<Label> placed_caption(const StripLayout& strip, const Scene& scene, const Layout& layout,
                                  const std::vector<StripCurve>& curves, bool starts_equal);

/// The number of lines that a caption takes for any values.
int caption_lines(StripKind kind, const Scene& scene, const Layout& layout, float width);

}  // namespace doppel

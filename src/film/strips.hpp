#pragma once

#include "film/layout.hpp"
#include "image/color.hpp"
#include "scene/scene.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A curve of a strip at a moment; with a name where the strip has several.
struct StripCurve {
    std::optional<double> value;
    Color color;
    double width = 0;  // px
    std::string name{};
};

/// What goes up in a strip, where curves of one line are `width` px wide. Potential energies count from the lowest point
/// that a chain reaches; the energy of a driven side is the mean over the drive's last period.
std::vector<StripCurve> strip_curves(StripKind kind, const Scene& scene, const PairState& state, double start_distance,
                                     const Theme& theme, double width);

/// ln(d/d0) / t, 1/s: nothing in the first twentieth of the scene, when it says nothing yet, or where a distance is 0.
std::optional<double> growth_rate(const Scene& scene, const PairState& state, double start_distance);

/// A line below a caption's words is so many px further down; the last one is so far above the curves.
float caption_line(const Layout& layout);
float above_curves(const Layout& layout);

/// The caption of a strip whose curves are `curves`, in lines no wider than `width` px: what it shows, the value of one
/// curve, the names of several. The first line begins at (0, 0).
std::vector<Label> strip_caption(StripKind kind, const Scene& scene, const Layout& layout,
                                 const std::vector<StripCurve>& curves, bool is_alike, float width);

/// How many lines the caption takes, whatever the curves do.
int caption_lines(StripKind kind, const Scene& scene, const Layout& layout, float width);

}  // namespace doppel

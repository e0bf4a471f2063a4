#pragma once

#include "image/theme.hpp"
#include "render/display_list.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// What all parts of a figure share: colours, sizes of text (px an em) and of lines (px).
struct PlotStyle {
    const Theme& theme;
    float unit;   // of a picture of 1600 × 900, px
    float scale;  // pixels that one px becomes in the end: what images are drawn for

    float title = 37 * unit, subtitle = 21 * unit, heading = 24 * unit;
    float axis = 20 * unit, tick = 18.5f * unit, text = 20 * unit, caption = 18 * unit;
    float hairline = unit > 0.9f ? unit : 1, line = std::max(1.0f, std::round(hairline));  // line: of whole pixels
    float curve = unit > 0.47f ? 3.2f * unit : 1.5f, thin = unit > 0.5f ? 2 * unit : 1;
    float marker = unit > 0.4f ? 5.2f * unit : 2.1f;  // its radius
};

}  // namespace doppel

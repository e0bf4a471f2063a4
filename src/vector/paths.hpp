#pragma once

#include "render/display_list.hpp"

#include <variant>
#include <vector>

namespace doppel {

/// A path that is filled, or drawn with a round pen.
struct Path {
    struct Step {
        enum class Kind { move, line, curve, close } kind = Kind::move;
        Point to;             // px; of close: ignored
        Point leave, arrive;  // control points of a cubic Bézier curve
    };
    std::vector<Step> steps;
    Color color;
    float pen = 0;  // px; 0 = filled
    bool has_round_ends = true;
};

/// What pages are made of, back to front.
using PageItem = std::variant<Path, Label, Image>;

/// The display list as paths, text and images. Circles are four cubic curves each (0.03 % of the radius off); a stroke
/// of even opacity and width is one path, any other a path for each even part; glows are stacks of wide faint paths.
std::vector<PageItem> page_items(const DisplayList& list);

}  // namespace doppel

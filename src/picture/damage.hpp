#pragma once

#include "picture/picture.hpp"

#include <vector>

namespace doppel {

struct Sketch;

/// Few rectangles, none overlapping, that hold all of `rects` and more: those are joined that are cheaper to handle as
/// one.
std::vector<Rect> merged(std::vector<Rect> rects);

/// Where the two sketches may differ, as few rectangles that do not overlap. Elsewhere the same marks lie in the same
/// order.
std::vector<Rect> damage(const Sketch& before, const Sketch& after);

}  // namespace doppel

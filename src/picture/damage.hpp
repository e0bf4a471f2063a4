#pragma once

#include "picture/picture.hpp"

#include <cstddef>

namespace doppel {

struct Sketch;

/// Few rectangles that hold all of `rects`: those are joined that are cheaper to handle as one.
std::vector<Rect> merged(std::vector<Rect> rects);

/// What every few of bounds[begin…end) cover together.
std::vector<Rect> chunks(const std::vector<Rect>& bounds, std::size_t begin, std::size_t end);

/// Where the two sketches may differ. Elsewhere the same quads lie in the same order.
std::vector<Rect> damage(const Sketch& before, const Sketch& after);

}  // namespace doppel

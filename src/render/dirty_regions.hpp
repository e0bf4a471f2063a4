#pragma once

#include "image/picture.hpp"

#include <vector>

namespace doppel {

struct RenderList;

/// Few rectangles, none overlapping, that hold all of `rects` and more: those are joined that are cheaper to handle as
/// one.
std::vector<Rect> merged(std::vector<Rect> rects);

/// Where the two render lists may differ, as few rectangles that do not overlap. Elsewhere the same primitives lie in
/// the same order.
std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after);

}  // namespace doppel

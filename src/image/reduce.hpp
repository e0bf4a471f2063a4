#pragma once

#include "image/color.hpp"
#include "image/picture.hpp"

#include <span>

namespace doppel {

/// The picture made smaller: each new pixel is the mean, in linear light, of what it covers of the old ones, parts of
/// pixels included, each weighted by its opacity. Throws Error (exit 2) where a side would grow, or be none.
Picture reduced(const Picture& picture, Size size);

/// Pictures of one size in rows of `columns`, `gap_px` of background between them and around all; in the last row
/// some may be missing. Throws Error (exit 2) where there is none, their sizes differ, or columns < 1 or gap_px < 0.
Picture contact_sheet(std::span<const Picture> pictures, int columns, int gap_px, Color background);

}  // namespace doppel

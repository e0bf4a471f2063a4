#pragma once

#include "figure/preset.hpp"
#include "image/color.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"

namespace doppel {

/// Writes the map that `page` shows: NAME.tiles/, a pyramid of tiles of 256 × 256 pixels, LEVEL-ROW-COLUMN.png from the
/// top left; level 0 has one tile, the last level one pixel per cell. Also writes NAME.html, a viewer for mouse, touch
/// and keys without network. Returns its manifest entry. Throws Error: exit 4; 130 soon after `stop` is set.
Json write_tiles(const FigurePreset& figure, const Figure& page, const Theme& theme, Transaction& files, int jobs,
                 const std::atomic<bool>& stop);
/// Throws Error (exit 2) if the figure is not a single map, or if its own format writes a page.
void require_map(const FigurePreset& figure);

}  // namespace doppel

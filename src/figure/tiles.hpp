#pragma once

#include "figure/preset.hpp"
#include "image/color.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"

namespace doppel {

/// Writes the map that `page` shows: NAME.tiles/ with a pyramid of tiles of 256 × 256 pixels, LEVEL-ROW-COLUMN.png from the
/// top left, of level 0 one, of the last with a pixel a cell; and NAME.html to look at them, with a mouse, by touch or with
/// keys, without a network. Returns what the manifest says of it. Throws Error: exit 4; 130 soon after `stop` is set.
Json write_tiles(const FigurePreset& figure, const Figure& page, const Theme& theme, Transaction& files, int jobs,
                 const std::atomic<bool>& stop);
/// Throws Error (exit 2) where the figure is no map, or several, or its own format writes a page.
void require_map(const FigurePreset& figure);

}  // namespace doppel

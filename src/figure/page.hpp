#pragma once

#include "figure/preset.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"

#include <string>

namespace doppel {

/// A page (HTML) of the figure `drawn`: its picture, SVG or PNG of twice its size, whichever is smaller, and the numbers
/// of the cell or point under the pointer. A click in a figure with releases() opens the release in a player.
std::string figure_page(const FigurePreset& figure, Figure drawn);

/// Writes the map that `page` shows: NAME.tiles/, a pyramid of tiles of 256 × 256 pixels, LEVEL-ROW-COLUMN.png from the
/// top left; level 0 has one tile, the last level one pixel per cell. Also writes NAME.html, a viewer for mouse, touch
/// and keys without network. Returns its manifest entry. Throws Error: exit 4; 130 soon after `stop` is set.
Json write_tiles(const FigurePreset& figure, const Figure& page, Transaction& files, int jobs,
                 const std::atomic<bool>& stop);
/// Throws Error (exit 2) if the figure is not a single map.
void require_map(const FigurePreset& figure);

}  // namespace doppel

#pragma once

#include "figure/preset.hpp"
#include "image/color.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"

namespace doppel {

/// A map as a pyramid of square tiles, from one tile that shows all of it to tiles with a pixel a cell.
struct Pyramid {
    static constexpr int tile = 256;  // pixels of a side

    int columns, rows;  // cells
    int levels;         // beyond level 0, the one tile; each has twice as many cells to a side of it as the next

    explicit Pyramid(int columns, int rows);

    /// Tiles of a level, from the top left.
    int across(int level) const { return tiles(columns, level); }
    int down(int level) const { return tiles(rows, level); }
    /// "3-0-7.png": level, row of tiles from the top, column.
    static std::string name(int level, int row, int column);

private:
    int tiles(int cells, int level) const;
};

/// Writes the map that `page` shows: NAME.tiles/ with a pyramid of tiles, and NAME.html to look at them, with a mouse, by
/// touch or with keys, without a network. Returns what the manifest says of it. Throws Error: exit 4; 130 soon after `stop`
/// is set.
Json write_tiles(const FigurePreset& figure, const Figure& page, const Theme& theme, Transaction& files, int jobs,
                 const std::atomic<bool>& stop);
/// Throws Error (exit 2) where the figure is no map, or several.
void demand_map(const FigurePreset& figure);

}  // namespace doppel

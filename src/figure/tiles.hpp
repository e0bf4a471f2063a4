#pragma once

#include "figure/run.hpp"

namespace doppel {

/// A map as a pyramid of square tiles, from one tile that shows all of it to tiles with a pixel a cell.
struct Pyramid {
    static constexpr int tile = 256;  // pixels of a side

    int columns, rows;  // cells
    int levels;         // beyond level 0, the one tile; each has twice as many cells to a side of it as the next

    explicit Pyramid(int columns, int rows);

    /// Tiles of a level, from the top left; cells to a pixel.
    int across(int level) const { return tiles(columns, level); }
    int down(int level) const { return tiles(rows, level); }
    /// "3-0-7.png": level, row of tiles from the top, column.
    static std::string name(int level, int row, int column);

private:
    int tiles(int cells, int level) const;
};

/// Makes the map `figure` as tiles and a page to look at them: OUT/NAME/NAME.html, NAME.tiles/ with the tiles and
/// pyramid.json, which says what they belong to, and the manifest NAME.tiles.json.
///
/// Each tile appears whole or not at all, and stays; the same command goes on with those that are missing. A shard
/// computes its share of the finest tiles alone; a merge makes the rest from them. No more than one tile a thread is in
/// memory. Colours go by [grid] color_range, or by the numbers of 4096 cells spread over the map.
///
/// Errors: exit 2 where the figure is no map, 75 where parts are missing at a merge; exit 3 as compute(), or where no cell
/// has a number; exit 4 where the folder of tiles is of another preset or version, or not Doppel's; exit 130 soon after
/// `stop` is set, all tiles made so far kept.
void make_tiles(const FigurePreset& figure, const FigureOptions& options, const std::atomic<bool>& stop,
                const ComputationReport& report, const std::function<void(const RunResult&)>& done);
/// Throws Error (exit 2) where the figure is no map.
void demand_map(const FigurePreset& figure);

}  // namespace doppel

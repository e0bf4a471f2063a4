#pragma once

#include "figure/map_figure.hpp"
#include "figure/tiles.hpp"

namespace doppel {

/// What a page to look at tiles says and shows.
struct TilePage {
    std::string title, subtitle;
    std::string folder;  // of the tiles, beside the page
    Pyramid pyramid;
    const MapFrame& frame;
    const HeatMap& look;  // with both ends of its scale
    const Theme& theme;
};

/// A page that needs no network: to pan and zoom with a mouse, by touch or with keys. Throws Error (exit 4).
void write_tile_page(const std::filesystem::path& place, const TilePage& page);

}  // namespace doppel

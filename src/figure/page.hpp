#pragma once

#include "figure/preset.hpp"
#include "image/color.hpp"

#include <string>

namespace doppel {

/// A page (HTML) of the figure `drawn`: its picture, SVG or PNG of twice its size, whichever is smaller. It shows the
/// numbers of the cell or point under the pointer. A click in a map or sweep over release angles, of chains of one to
/// three ideal links, opens the release in a player.
std::string figure_page(const FigurePreset& figure, Figure drawn, const Theme& theme);

}  // namespace doppel

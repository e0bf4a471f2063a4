#pragma once

#include "figure/preset.hpp"
#include "image/color.hpp"
#include "scene/resolved.hpp"

#include <string>

namespace doppel {

/// A page (HTML) of the figure `drawn`: its picture, SVG or PNG of twice its size, whichever has fewer bytes, and the numbers of
/// the cell or point that is pointed at. In a map or a sweep over release angles of chains of one to three ideal links, a click
/// opens the release there in a player.
std::string figure_page(const FigurePreset& figure, Figure drawn, const Theme& theme);

/// An axis as scripts read it: its label, the values `from` … `to`, and the pixels `start` … `end`.
Json axis_json(const std::string& label, const Axis& axis);

}  // namespace doppel

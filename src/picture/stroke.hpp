#pragma once

#include "picture/display_list.hpp"

#include <cstddef>

namespace doppel {

/// A part of a stroke that is drawn at once: from vertex `first` to vertex `last` along a parabola that rises `bend` px
/// to the left of the straight line between them. Opacity, width and glow vary linearly along that line.
struct StrokePiece {
    std::size_t first, last;
    float bend = 0;
};

/// Whether pieces may bend, as those of a smooth path may, or are straight.
enum class Bends { no, yes };

/// The piece from vertex `first` that reaches far, at most `most` vertices on or to a joint, and passes all between
/// within a hair (1/10 px of place and of either edge, 1/5 px of place half way between two vertices, 1/2 px of glow,
/// 1/255 of opacity); widths and glow in px. Simulated paths have many more vertices than bends.
StrokePiece next_piece(const std::vector<Stroke::Vertex>& path, std::size_t first, Bends bends, std::size_t most = 24);

}  // namespace doppel

#pragma once

#include "figure/experiment.hpp"
#include "figure/part_file.hpp"
#include "figure/spacing.hpp"

#include <string>
#include <vector>

namespace doppel {

/// The cells of a map and what they look like.
struct MapFrame {
    CellRange x, y;
    PlotAxis x_axis, y_axis;
    HeatMap look;              // the scale and its words
    std::size_t numbers = 1;   // of a cell, of which the first is drawn
    std::size_t panels = 1;    // maps of the figure, each of as many cells
    bool is_mirrored = false;  // the cell at (−x, −y) has the same numbers
};

/// A figure that is a map, whose cells can be found one by one. The numbers of a cell that has none are NaN or infinite.
class MapFigure {
public:
    virtual ~MapFigure() = default;
    const MapFrame& frame() const { return frame_; }
    /// The numbers of cells of the first map, side by side in a row, the first of them at `column`. Throws as
    /// Experiment::compute().
    virtual void find(int row, int column, std::span<TrialNumbers> cells, const std::atomic<bool>& stop) const = 0;

protected:
    MapFrame frame_;
};

/// Throws Error (exit 2) where the trials of `header` are so many cells of maps that memory, or the disk of `folder`,
/// does not hold them. Nothing of other figures.
void demand_room(const FigurePreset& figure, const PartHeader& header, const std::filesystem::path& folder);

}  // namespace doppel

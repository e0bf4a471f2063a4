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
    PlotAxis x_axis, y_axis;           // without their ends
    std::vector<std::string> columns;  // of the table: x, y, then the numbers of a cell, of which the first is drawn
    HeatMap look;                      // the scale and its words
    bool is_mirrored = false;          // the cell at (−x, −y) has the same numbers
};

/// The numbers of a cell that has none are NaN or infinite.
inline constexpr int most_cells_across = 1'048'576;  // across, or down

/// A figure that is one map. Its first trials are rows of cells, from y_low up; of a mirrored map the lower half of them.
/// Kinds may have further trials.
class MapFigure : public Experiment {
public:
    const MapFigure* map() const override { return this; }
    const MapFrame& frame() const { return frame_; }
    /// The numbers of cells side by side in a row, the first of them at `column`. Throws as compute().
    virtual void find(int row, int column, std::span<TrialNumbers> cells, const std::atomic<bool>& stop) const = 0;
    /// Whether these can be those of a cell.
    virtual bool fits_cell(std::span<const double> numbers) const = 0;

    std::size_t trials() const override { return row_trials() + other_trials(); }
    double units(std::size_t trial) const override;
    bool fits(std::size_t trial, std::span<const double> numbers) const override;
    std::vector<std::string> columns() const override { return frame_.columns; }
    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override;
    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override;

protected:
    MapFrame frame_;

    std::size_t row_trials() const;
    virtual std::size_t other_trials() const { return 0; }
    virtual TrialNumbers compute_other(std::size_t /*trial*/, const std::atomic<bool>& /*stop*/) const { return {}; }
    virtual bool fits_other(std::size_t /*trial*/, std::span<const double> /*numbers*/) const { return false; }

    /// The number that is drawn, NaN where the cell has none.
    double at(std::span<const TrialNumbers> numbers, int row, int column) const;
    std::span<const double> numbers_at(std::span<const TrialNumbers> numbers, int row, int column) const;

private:
    std::size_t numbers_in_cell() const { return frame_.columns.size() - 2; }
    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override;
};

/// Throws Error (exit 2) where the trials of `header` are so many cells of a map that memory, or the disk of `folder`,
/// does not hold them. Nothing of other figures.
void demand_room(const FigurePreset& figure, const PartHeader& header, const std::filesystem::path& folder);

}  // namespace doppel

#pragma once

#include "figure/grid_axis.hpp"
#include "figure/quantity.hpp"
#include "scene/captions.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// Theoretical curves on a map.
enum class Overlay { none, kapitza, mathieu, energy_bound, linear_limit };
template <>
inline constexpr auto names_of<Overlay> = std::to_array<std::string_view>({"none", "kapitza", "mathieu", "energy-bound",
                                                                           "linear-limit"});

/// A quantity of pairs over the values of one to four keys: curves over x, in several colours; maps over x and y;
/// panels of either. A trial is some adjacent points or cells that are best computed together; of a map with a mirror
/// symmetry, those in its lower half.
class Grid final : public Experiment {
public:
    static constexpr std::string_view table_key = "grid";
    Grid() = default;
    explicit Grid(FigureReader& reader);

    void fields(KeyVisitor& visit);

    std::size_t trials() const override { return groups_.back().first + trials_of(groups_.back()); }
    double units(std::size_t trial) const override;
    std::optional<Releases> releases() const override;
    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override;
    bool fits(std::size_t trial, std::span<const double> numbers) const override;
    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override;
    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override;
    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override;  // figure/grid_plot.cpp

private:
    /// The pairs of one panel and colour, which differ only along x and y.
    struct Group {
        Preset pair;
        GridAxis x;
        std::size_t first = 0;                  // first trial
        std::vector<Measurement> measurements;  // of the quantity, and of that on the right axis
    };
    struct Cell {
        std::size_t group, row, column;
    };

    void check(const TomlReader& table) const;
    void add_group(FigureReader& reader, const TomlReader& table, std::size_t p, std::size_t c);
    void make_map();
    void make_subtitle();
    /// What the axes set, and subtitles leave out.
    SweptKeys swept_keys() const;
    /// Whether an axis sets the model, the method, its step or its precision.
    bool compares_methods() const;
    template <class Add>
    void visit_columns(const Cell& cell, std::size_t row, std::span<const double> numbers, const Add& add) const;

    bool is_map() const { return y_.exists(); }
    bool is_of_releases() const;
    const std::vector<Measurement>& measurements() const { return groups_.front().measurements; }
    const QuantityWords& words() const { return measurements().front().words(); }
    Preset pair_at(const Cell& cell) const;
    void put(const Cell& cell, Preset& pair) const;

    std::size_t lines_computed(const Group& group) const;
    std::size_t line_cells(const Group& group) const { return are_columns_ ? y_.count : group.x.count; }
    std::size_t trials_of_line(const Group& group) const { return (line_cells(group) + piece_ - 1) / piece_; }
    std::size_t trials_of(const Group& group) const { return lines_computed(group) * trials_of_line(group); }
    Cell place_of(std::size_t trial) const;
    std::size_t cells_of(std::size_t trial) const;
    /// The numbers of a cell, from the cell or from its mirror image.
    std::span<const double> at(std::span<const TrialNumbers> numbers, const Cell& cell) const;
    /// The drawn number of a cell.
    double value_at(std::span<const TrialNumbers> numbers, const Cell& cell) const {
        return at(numbers, cell)[words().drawn];
    }
    template <class Visit>
    void for_each_cell(const Visit& visit) const {
        for (std::size_t group = 0; group < groups_.size(); ++group)
            for (std::size_t row = 0; row < y_.count; ++row)
                for (std::size_t column = 0; column < groups_[group].x.count; ++column) visit(Cell{group, row, column});
    }
    bool is_missing(const Cell& cell, Quantity quantity, double number) const;
    /// Whether a curve of distances has no point: both pendulums rest in equilibrium, and the distance is constant.
    bool leaves_out(const Cell& cell) const;
    /// "rk4, θ₂ = 30°"; empty if there is only one group.
    std::string joined_words(std::size_t group) const;
    double slope(std::span<const TrialNumbers> numbers, std::size_t group) const;

    // figure/grid_plot.cpp
    Curve curve(std::span<const TrialNumbers> numbers, std::size_t group, std::size_t column) const;
    void draw_curves(std::span<const TrialNumbers> numbers, std::size_t group, Plot& plot, Figure& figure) const;
    std::string rest_words() const;
    void finish_convergence(std::span<const TrialNumbers> numbers, Figure& figure) const;
    void draw_linear_limit(std::size_t p, Plot& plot) const;
    HeatMap heat_map(std::span<const TrialNumbers> numbers, std::size_t group) const;
    void finish_maps(std::span<const TrialNumbers> numbers, Figure& figure) const;

    Preset pair_;
    GridAxis x_{"x", GridAxis::key_help, "theta1_deg"}, y_{"y", "the vertical axis of a map"},
        color_{"color", "a curve for each value"}, panel_{"panel", "a panel for each value"};
    Quantity quantity_ = Quantity::divergence;
    std::optional<std::string> right_;
    Quad difference_ = 0;
    QuantityOptions options_;
    Overlay overlay_ = Overlay::none;
    std::optional<Rational> mark_step_;
    std::optional<Range> range_;
    std::optional<double> threshold_;
    std::vector<Group> groups_;                 // panel by panel, with the colours of each
    std::size_t cell_numbers_ = 0, piece_ = 1;  // numbers of a cell; cells of a trial
    HeatMap map_style_;                         // the map without its values
    bool is_mirrored_ = false;                  // the cell at (−x, −y) has the same numbers
    bool are_columns_ = false;                  // the cells of a trial form a column: they share one setting
};

}  // namespace doppel

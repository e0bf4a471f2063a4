#pragma once

#include "output/csv.hpp"
#include "plot/plot.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace doppel {

/// The numbers that one trial of a figure comes to, at least one; NaN where one is missing.
using TrialNumbers = std::vector<double>;

/// Whether all are numbers, neither infinite nor NaN.
inline bool all_finite(std::span<const double> numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// Whether each is a number, or NaN where one could not be had.
inline bool finite_or_none(std::span<const double> numbers) {
    return std::none_of(numbers.begin(), numbers.end(), [](double x) { return std::isinf(x); });
}

/// Whether it is a whole number ≥ 0, small enough to be exact in a double.
inline bool is_count(double x) {
    return x >= 0 && x <= 0x1p53 && x == std::floor(x);
}

/// A part of a trial's numbers with names: a struct of doubles and nothing else.
template <class Row>
concept NumberRow = std::is_trivially_copyable_v<Row> && sizeof(Row) % sizeof(double) == 0;

template <NumberRow Row>
inline constexpr std::size_t numbers_in = sizeof(Row) / sizeof(double);

/// The first row of the numbers, which hold one.
template <NumberRow Row>
Row row_of(std::span<const double> numbers) {
    std::array<double, numbers_in<Row>> first;
    std::copy_n(numbers.begin(), first.size(), first.begin());
    return std::bit_cast<Row>(first);
}

/// All rows of the numbers, whose count is a multiple of a row's.
template <NumberRow Row>
std::vector<Row> rows_of(std::span<const double> numbers) {
    std::vector<Row> rows;
    for (; !numbers.empty(); numbers = numbers.subspan(numbers_in<Row>)) rows.push_back(row_of<Row>(numbers));
    return rows;
}

template <NumberRow Row>
void append(TrialNumbers& numbers, const Row& row) {
    for (const double value : std::bit_cast<std::array<double, numbers_in<Row>>>(row)) numbers.push_back(value);
}

template <NumberRow Row>
TrialNumbers numbers_of(const Row& row) {
    TrialNumbers numbers;
    append(numbers, row);
    return numbers;
}

/// Adds a whole row to the table: text, whole numbers, and doubles, whose cell is empty where one is NaN.
template <class... Cells>
void add_row(Csv& table, const Cells&... cells) {
    const auto add = [&](const auto& cell) {
        using Cell = std::decay_t<decltype(cell)>;
        if constexpr (std::is_same_v<Cell, double>)
            table.add_or_empty(cell);
        else if constexpr (std::is_integral_v<Cell>)
            table.add(static_cast<long>(cell));
        else
            table.add(std::string_view(cell));
    };
    (add(cells), ...);
    table.end_row();
}

inline void add_point(Curve& curve, double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
}

/// A result of a figure beside its table: a key of the manifest.
struct Finding {
    std::string key;
    std::variant<double, std::string, bool> value;
};

/// The cells of a figure of maps: of each panel so many, each of so many numbers.
struct MapCells {
    int columns, rows;
    std::size_t panels, numbers;
};

/// What a figure computes and shows: independent trials, and the table, picture and findings of their numbers. They may
/// be computed in any order, by any thread, in several runs on several machines; the numbers are the same to the bit.
class Experiment {
public:
    virtual ~Experiment() = default;

    virtual std::size_t trials() const = 0;
    /// How many trials in a row one call of compute() takes best. Changes no result.
    virtual std::size_t together() const { return 1; }
    /// Whether its trials measure time, and so are computed one after the other, by themselves.
    virtual bool measures_time() const { return false; }
    /// The unit of progress, "pairs", and how many of them a trial is; 0 for what other trials need first.
    virtual std::string unit() const { return "trials"; }
    virtual double units(std::size_t /*trial*/) const { return 1; }

    /// Trials first, first + 1 … one for each of `numbers`. Throws Error: exit 3 where a method fails and nothing
    /// is left to show, exit 130 soon after `stop` is set.
    virtual void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const {
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = compute_trial(first + i, stop);
    }

    /// Whether the numbers can be those of the trial: as many as it has, and infinite or NaN only where they may be.
    /// Both those read from files and those just computed are checked.
    virtual bool fits(std::size_t trial, std::span<const double> numbers) const = 0;

    /// The table: its columns, and its rows from the numbers of all trials.
    virtual std::vector<std::string> columns() const = 0;
    virtual void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const = 0;

    /// Why there is nothing to draw, as where every trial failed; nothing where there is.
    virtual std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> /*numbers*/) const { return {}; }

    /// The panels (or the page), and captions that hold numbers just found. Titles are there already.
    virtual void draw(std::span<const TrialNumbers> numbers, Figure& figure) const = 0;
    virtual std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const = 0;

    /// What a picture says below its title where the preset has no subtitle: what moves, and how it is integrated.
    virtual std::string subtitle() const { return {}; }

    /// Of a figure of maps: its panels each draw one; nothing of other figures.
    virtual std::optional<MapCells> map() const { return std::nullopt; }

    /// Everything that the numbers depend on, as the preset's tables would say it (TOML).
    const std::string& resolved() const { return settings_; }
    /// The keys of [chart] among it.
    const std::string& resolved_chart() const { return chart_settings_; }

protected:
    std::string settings_, chart_settings_;

    /// One trial, of a kind that computes no two together.
    virtual TrialNumbers compute_trial(std::size_t /*trial*/, const std::atomic<bool>& /*stop*/) const { return {}; }
};

}  // namespace doppel

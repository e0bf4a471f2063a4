#pragma once

#include "integrate/motion.hpp"
#include "output/csv.hpp"
#include "plot/plot.hpp"
#include "scene/preset.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace doppel {

/// The results of one trial, at least one number; NaN if one is missing.
using TrialNumbers = std::vector<double>;

inline bool all_finite(std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

/// Whether each is finite or NaN (missing).
inline bool finite_or_none(std::span<const double> numbers) {
    return std::ranges::none_of(numbers, [](double x) { return std::isinf(x); });
}

/// Whether it is an integer ≥ 0 that is exact in a double.
inline bool is_count(double x) {
    return x >= 0 && x <= 0x1p53 && x == std::floor(x);
}

/// A struct that only consists of doubles: named numbers of a trial.
template <class Row>
concept NumberRow = std::is_trivially_copyable_v<Row> && sizeof(Row) % sizeof(double) == 0;

template <NumberRow Row>
inline constexpr std::size_t numbers_in = sizeof(Row) / sizeof(double);

template <NumberRow Row>
Row row_of(std::span<const double> numbers) {
    std::array<double, numbers_in<Row>> first;
    std::copy_n(numbers.begin(), first.size(), first.begin());
    return std::bit_cast<Row>(first);
}

/// All rows of the numbers; their count must be a multiple of a row's.
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

/// Adds a row to the table: text, whole numbers and doubles. NaN gives an empty cell.
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

/// The numbers of cells of a map figure: in each panel, and numbers per cell.
struct MapCells {
    int columns, rows;
    std::size_t panels, numbers;
};

/// What a figure computes and shows: independent trials, and the table and picture made from their numbers,
/// which are identical in any order, on any thread and machine.
class Experiment {
public:
    virtual ~Experiment() = default;

    virtual std::size_t trials() const = 0;
    /// Whether trials measure time. They are then computed one after the other, without other work.
    virtual bool measures_time() const { return false; }
    /// How many trials the table merges into one.
    virtual double merged_trials() const { return 1; }
    /// How many numbers are a point of its curves and a row of its table.
    virtual double numbers_in_row() const { return 1; }
    /// The unit of progress, "pairs", and how many of them a trial counts; 0 for trials that others require first.
    const std::string& unit() const { return unit_; }
    virtual double units(std::size_t /*trial*/) const { return 1; }

    /// Throws Error: exit 3 if a method fails and nothing can be shown, exit 130 soon after `stop` is set.
    virtual TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const = 0;

    /// For estimates, the same over about `share` of the time; nothing if it cannot be shortened.
    struct Part {
        std::shared_ptr<const Experiment> experiment;
        double share;         // of the time that the whole takes to compute
        std::size_t numbers;  // of all trials of the whole
    };
    virtual std::optional<Part> part(double /*share*/) const { return std::nullopt; }

    /// Whether numbers, read or computed, are valid for the trial: their count, and infinity or NaN only where allowed.
    virtual bool fits(std::size_t trial, std::span<const double> numbers) const = 0;

    /// The columns of the table, and its rows from the numbers of all trials.
    const std::vector<std::string>& columns() const { return columns_; }
    virtual void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const = 0;

    /// Why nothing can be drawn, for example because every trial failed; otherwise nothing.
    virtual std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> /*numbers*/) const { return {}; }

    /// Adds the panels, and captions with results. Titles are already set.
    virtual void draw(std::span<const TrialNumbers> numbers, Figure& figure) const = 0;

    /// The subtitle if the preset has none: the system and the integrator.
    const std::string& subtitle() const { return subtitle_; }

    /// For map figures, in which each panel shows one map; otherwise nothing.
    const std::optional<MapCells>& map() const { return map_; }

    /// For maps and sweeps over release angles of one to three ideal links: the keys of the axes, x first, and a pair.
    struct Releases {
        std::vector<std::string> keys;
        Preset pair;
    };
    virtual std::optional<Releases> releases() const { return std::nullopt; }

    /// All settings that the numbers depend on, as tables of the preset (TOML); the last one is [chart].
    const std::string& resolved() const { return settings_; }

protected:
    // set by constructors
    std::string unit_ = "trials", subtitle_, settings_;
    std::vector<std::string> columns_;
    std::optional<MapCells> map_;
};

/// The kind's own table and [chart] with all its keys, TOML.
template <class Kind>
std::string settings_text(Kind& kind) {
    TomlWriter own{std::string(Kind::table_key)}, chart;
    kind.fields(own);
    if constexpr (requires { kind.further_fields(chart); }) kind.further_fields(chart);
    return fmt::format("\n[{}]\n{}\n[chart]\n{}", Kind::table_key, own.text(), chart.text());
}

/// A preset being read: each kind of figure reads its own tables.
struct FigureReader {
    std::string name;                 // of the preset
    TomlReader &top, &scene, &chart;  // a kind may read further keys of [chart]
    const std::atomic<bool>& stop = never_stopped;
    bool only_keys = false;  // each key is read by itself, so that all errors are found, and nothing is checked further

    /// Reads all fields of the kind's own table.
    template <class Kind>
    TomlReader settings(Kind& kind) {
        auto table = top.inner(Kind::table_key);
        kind.fields(table);
        table.finish();
        return table;
    }
    /// The pair described by [scene], [system], [a] and [b], with `more` levels on top (scene/preset_fields.hpp).
    Preset pair(const std::vector<TomlReader*>& more = {});
    /// The chain that [system] describes, for figures that integrate it themselves. `physical`: links with mass,
    /// friction and drives are allowed.
    SideSpec release(bool physical = false);
};

/// Throws Error (exit 2) if a key lists a name or value twice.
void check_distinct(const TomlReader& table, std::string_view key, const std::vector<std::string>& names);

/// The methods of these names that integrate a model, in the same order.
std::vector<std::string> methods_of(Model model, std::vector<std::string> names);

/// Whether both sides have the same release, so that their initial distance is 0.
bool have_same_release(const SideSpec& a, const SideSpec& b);

/// An entry of the list of kinds.
struct FigureKind {
    std::string_view name;  // in [scene]
    std::shared_ptr<const Experiment> (*read)(FigureReader&);
    void (*list)(KeyVisitor&);  // visits the kind's own tables, with their defaults
};

/// A kind is a class constructed from a FigureReader; with only_keys, the constructor returns when it has read all keys:
/// those of its own table `table_key`, which fields(visit) visits, and those of further_fields(visit) in [chart].
template <class Kind>
constexpr FigureKind kind_of(std::string_view name) {
    return {name,
            [](FigureReader& reader) -> std::shared_ptr<const Experiment> { return std::make_shared<Kind>(reader); },
            [](KeyVisitor& visit) {
                Kind kind;
                visit.table(Kind::table_key, [&](KeyVisitor& table) { kind.fields(table); });
                if constexpr (requires { kind.further_fields(visit); })
                    visit.table("chart", [&](KeyVisitor& table) { kind.further_fields(table); });
            }};
}

/// The list is in figure/kinds.cpp, the names are in scene/preset_fields.hpp.
std::span<const FigureKind> figure_kinds();

// Each is defined in a file of its own.
extern const FigureKind grid_kind, series_kind, section_kind, work_precision_kind;

}  // namespace doppel

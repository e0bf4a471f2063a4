#pragma once

#include "analysis/exponent.hpp"
#include "analysis/pair_batch.hpp"
#include "figure/kinds.hpp"
#include "integrate/flips.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// Samples a driven pendulum at each drive period.
struct StroboscopeSpec {
    int link = 1;  // from 1
    int transient_periods = 200, periods = 100;
};

/// The quantities that a grid can compute for each pair.
enum class Quantity {
    divergence,
    exponent,
    flip_time,
    distance_at_end,
    greatest_distance,
    energy_error,
    parting_time,
    deviation,
    period,
    stroboscopic,
    step_cost,
    stability,
    convergence
};
template <>
inline constexpr auto names_of<Quantity> = std::to_array<std::string_view>(
    {"divergence", "exponent", "flip_time", "distance_at_end", "greatest_distance", "energy_error", "parting_time",
     "deviation", "period", "stroboscopic", "step_cost", "stability", "convergence"});

/// Whether it compares the two pendulums by their distance; otherwise it depends on side a alone.
constexpr bool is_of_distance(Quantity quantity) {
    return quantity == Quantity::divergence || quantity == Quantity::distance_at_end ||
           quantity == Quantity::greatest_distance || quantity == Quantity::parting_time ||
           quantity == Quantity::convergence;
}

/// The texts of a quantity in figures.
struct QuantityWords {
    std::string label;                     // of an axis, including the unit
    std::vector<std::string> columns;      // of the table, one for each number
    std::vector<std::string> curves = {};  // names of the numbers, if each is a curve
    bool logarithmic = false;
    std::string none = "run failed";  // label of cells without a number
    bool none_is_bad = none == "run failed";
    std::string method = {};          // by which it is found, if not by the preset's
    std::string short_label = {};     // beside a curve of another quantity
    std::string last_column = {};     // of one more number, after those of all quantities
    std::size_t rows = 1;             // rows of the table per pair, each with its own numbers
    std::size_t drawn = 0;            // index of the drawn number; if it is not 0, it is drawn over number 0
    std::optional<Range> range = {};  // of the colour scale of a map
};

/// The duration of the pair in words: "20", "0.5".
std::string seconds_text(const Preset& pair);
/// Options for quantities, set by keys of [grid].
struct QuantityOptions {
    double exponent_duration_s = ExponentSpec{}.duration_s;
    std::optional<double> flip_tolerance;  // rad/s
    StroboscopeSpec stroboscope;
};

/// What all pairs to measure have in common.
struct InCommon {
    bool are_ideal = true, have_same_links = true, have_same_method = true;
    bool are_compared_by_method = false;  // by an axis
    Quad difference = 0;                  // that the figure adds to side b of every pair
    bool is_of_one_side = false;          // it cannot: the key of x belongs to one side
};

/// Returns pair i; it stays valid until the next call.
using PairAt = std::function<const Preset&(std::size_t i)>;

/// Computes one quantity of pairs, if possible in SIMD lanes: the mean, distances and energies of chains of two or three
/// links in double by Euler or RK4; flips of two links by Taylor series, whatever the integrator. The numbers of a pair:
/// the quantity; for an exponent also its uncertainty; for a stroboscope angle and rate, row by row. NaN if the motion
/// failed or the pair never diverges; infinite if there is no flip.
class Measurement {
public:
    /// For pairs like the first and the last one. Throws Error (exit 2) at the table's `key` if the quantity is not defined
    /// for them; at `difference` or `quantity` if it compares two pendulums that are the same: in all pairs, or because
    /// the difference is lost in rounding, or because `divergence` starts at distance 0.
    Measurement(const TomlReader& table, std::string_view key, Quantity quantity, const std::array<Preset, 2>& ends,
                const InCommon& all, const QuantityOptions& options);

    /// How flips are found in lanes, if they are.
    std::optional<FlipSpec> flips_in_lanes() const { return flips_in_lanes_ ? std::optional(flip_) : std::nullopt; }

    const QuantityWords& words() const { return words_; }
    Quantity quantity() const { return quantity_; }
    std::size_t numbers() const { return words_.columns.size() * words_.rows + (words_.last_column.empty() ? 0 : 1); }
    /// The best number of pairs per call, the same on all machines. `shared`: consecutive pairs have one pendulum in common.
    std::size_t together(bool shared) const;
    /// Appends numbers() results for each pair. Throws Error (exit 130) soon after `stop` is set.
    void append(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    /// Whether the numbers are valid for one pair.
    bool fits(std::span<const double> numbers) const;

private:
    void append_in_lanes(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    void append_flips(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    void append_energies(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    TrialNumbers found(const Preset& pair, const std::atomic<bool>& stop) const;
    TrialNumbers watched(const Preset& pair, const std::atomic<bool>& stop) const;

    Quantity quantity_;
    QuantityWords words_;
    QuantityOptions options_;
    FlipSpec flip_;
    std::optional<PairBatchSpec> run_;
    bool flips_in_lanes_ = false;
};

}  // namespace doppel

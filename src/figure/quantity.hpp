#pragma once

#include "analysis/exponent.hpp"
#include "analysis/pair_batch.hpp"
#include "figure/experiment.hpp"
#include "figure/stroboscope.hpp"
#include "integrate/flips.hpp"
#include "scene/scene.hpp"
#include "scene/toml_reader.hpp"

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace doppel {

/// What a grid finds of each pair.
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
inline constexpr std::string_view quantity_help = "what is computed for each pair; docs/figures.md explains each";

/// Whether it compares the two of a pair by their distances.
constexpr bool is_of_distance(Quantity quantity) {
    return quantity == Quantity::divergence || quantity == Quantity::distance_at_end ||
           quantity == Quantity::greatest_distance || quantity == Quantity::parting_time ||
           quantity == Quantity::convergence;
}

/// What figures say of a quantity.
struct QuantityWords {
    std::string label;                     // of an axis, with the unit
    std::vector<std::string> columns;      // of the table, one a number
    std::vector<std::string> curves = {};  // the names of the numbers where each is a curve of its own
    bool logarithmic = false;
    std::string none = "run failed";  // what it means where there is none
    bool none_is_bad = none == "run failed";
    bool is_of_side_a = false;     // alone: what sets the two apart does not matter
    std::string method = {};       // by which it is found, where not by the preset's
    std::string short_label = {};  // of a curve beside that of another quantity
    std::string last_column = {};  // of one more number, after those of all quantities
    std::size_t rows = 1;          // of the table to a pair, each with numbers of its own
    std::string counted = {};      // the column that counts them
    long first_row = 0;
    std::size_t drawn = 0;            // which of the numbers is drawn; where not the first, over the first
    std::optional<Range> range = {};  // of the colours of a map
};

/// Whether any of the numbers is one, and one above 0.
struct Drawn {
    bool any = false, above_0 = false;
    void add(double number) {
        any |= std::isfinite(number);
        above_0 |= std::isfinite(number) && number > 0;
    }
};
/// That the pair is run for: "20", "0.5".
std::string seconds_text(const Preset& pair);
/// Why a picture of them has nothing in it; nothing where it has. `pairs` = how many there are,
/// each over so many seconds.
std::optional<std::string> nothing_drawn(Quantity quantity, const QuantityWords& words, const Drawn& drawn,
                                         const std::string& pairs, const std::string& seconds);

/// Throws Error (exit 2), of the table's `difference` or `quantity`, where a quantity that compares the two of a pair has
/// nothing to compare in the first and the last pair: they are one in all pairs, or `difference` is lost in rounding in
/// one of them, or `divergence` has no first distance.
void require_apart(const TomlReader& table, Quantity quantity, bool is_of_one_side, const Quad& difference,
                   const std::array<Scene, 2>& ends);

/// Counts the regular releases of a curve, and takes equilibria out of it: their exponent is not that of a motion.
std::string exponent_words(Curve& exponents, const std::vector<double>& unsettled, std::string_view unit);

/// How quantities are found, where keys of [grid] say.
struct QuantityOptions {
    double exponent_duration_s = ExponentSpec{}.duration_s;
    std::optional<double> flip_tolerance;  // rad/s
    StroboscopeSpec stroboscope;
};

/// Pair i of some, until the next is asked for.
using PairAt = std::function<const Preset&(std::size_t i)>;

/// Finds one quantity of pairs. Where all can be integrated side by side, in lanes: the mean, distances and energies of
/// chains of two or three links in double by Euler or RK4; flips of two links by Taylor series whatever the integrator.
/// The rest one by one.
///
/// The numbers of a pair: the quantity; of an exponent its uncertainty too; of a stroboscope angle and rate, row by
/// row. NaN where the motion failed, or the two never diverge; infinite where there is no flip.
class Measurement {
public:
    /// Of pairs like `pair`; `alike` = they have one method and as many links. Throws Error (exit 2), of the table's
    /// `key`, where such pairs have no such quantity.
    Measurement(const TomlReader& table, std::string_view key, Quantity quantity, const Preset& pair, bool alike,
                const QuantityOptions& options);

    /// How flips are found in lanes; nothing where they are not.
    std::optional<FlipSpec> flips_in_lanes() const { return flips_in_lanes_ ? std::optional(flip_) : std::nullopt; }

    const QuantityWords& words() const { return words_; }
    Quantity quantity() const { return quantity_; }
    std::size_t numbers() const { return words_.columns.size() * words_.rows + (words_.last_column.empty() ? 0 : 1); }
    /// How many pairs are best found at once, of which each next has one of its two in common with the last where
    /// `shared`.
    std::size_t together(bool shared) const;
    /// numbers() more for each pair. Throws Error (exit 130) soon after `stop` is set.
    void append(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    /// Whether they can be those of one pair.
    bool fits(std::span<const double> numbers) const;

private:
    void append_in_lanes(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    void append_flips(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    void append_energies(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const;
    TrialNumbers found(const Preset& pair, const std::atomic<bool>& stop) const;
    double watched(const Preset& pair, const std::atomic<bool>& stop) const;

    Quantity quantity_;
    QuantityWords words_;
    ExponentSpec exponent_;
    StroboscopeSpec stroboscope_;
    FlipSpec flip_;
    std::optional<PairBatchSpec> run_;
    MotionSpec motion_;  // of side a of the first pair
    bool flips_in_lanes_ = false;
};

}  // namespace doppel

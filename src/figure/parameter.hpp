#pragma once

#include "figure/kinds.hpp"
#include "figure/quantity.hpp"

#include <array>
#include <functional>
#include <optional>
#include <string>

namespace doppel {

inline constexpr std::string_view parameter_help =
    "what the pairs differ in: a numeric key (system.gravity_m_per_s2, b.mass_kg[1], "
    "system.force.NAME.stiffness_N_per_m), "
    "or theta1_deg, theta2_deg, mass_ratio, length_ratio";
inline constexpr Field parameter_field(std::string_view key, std::string_view help) {
    return {
        .key = key, .help = help, .pattern = R"(^(theta1_deg|theta2_deg|mass_ratio|length_ratio|(system|a|b)\..+)$)"};
}

/// What sweeps and maps vary: a number of a preset, or a ratio of two.
struct Parameter {
    std::string name, label;  // the column's; the axis's, with the unit
    Bounds bounds;
    double every = 0;                        // between ticks; 0 = as fits
    bool is_whole = false;                   // takes whole numbers alone
    bool is_of_method = false;               // a step, a tolerance or an accuracy
    bool keeps_method = true;                // pairs that differ in it have one method and as many links
    bool is_of_one_side = false;             // the two of a pair cannot differ by it
    std::optional<std::size_t> angle;        // the link, from 0, whose release it is
    std::function<Quad(const Quad&)> taken;  // what becomes of a value: a whole number, a step that divides a sample
    std::function<void(Preset&, const Quad& value, const Quad& difference)> set;  // of side b `difference` more
    std::function<void(Preset&, const Quad&)> set_both;  // of both sides, whichever it belongs to

    /// What two of a pair are called that are so much apart: "twins 0.003° apart"; empty for 0.
    std::string apart(const Quad& difference) const;
    /// Throws Error (exit 2), of `key`, where the value is out of range.
    void demand(const TomlReader& table, std::string_view key, const Quad& value) const;
};

/// The parameter that `key` of the table names. Throws Error (exit 2) where the pair has no such number.
Parameter parameter_of(FigureReader& reader, const TomlReader& table, std::string_view key, const std::string& name,
                       const Preset& pair);

/// The first and the last pair of a sweep or map.
using EndPairs = std::array<Scene, 2>;

/// Throws Error (exit 2), of the table's `difference` or `quantity`, where a quantity that compares the two of a pair
/// has nothing to compare: they are one in all pairs, or `difference` is lost in rounding in one of them, or `divergence`
/// has no first distance.
void demand_apart(const TomlReader& table, Quantity quantity, const Parameter& parameter, const Quad& difference,
                  const EndPairs& ends);

/// What moves, how it is stepped and how far twins are apart, of pairs that are alike but for the parameters, whose first
/// values are those of `pair`.
///
/// `difference`  of the first parameter between the two of a pair
/// `quantity`    that is found of each
std::string varied_subtitle(Preset pair, std::span<const Parameter* const> parameters, std::span<const Quad> values,
                            const Quad& difference, const QuantityWords& quantity);

}  // namespace doppel

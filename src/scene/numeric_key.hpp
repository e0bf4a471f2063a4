#pragma once

#include "scene/toml_reader.hpp"

#include <optional>
#include <string>

namespace doppel {

/// A number of a preset that curves and maps vary, given by its path: "system.gravity_m_per_s2", "b.mass_kg[1]"
/// (elements count from 0; without an index, all), "system.force.spring.stiffness_N_per_m" (an entry by its name, or by
/// its kind if it is the only one).
struct NumericKey {
    enum class Sides { both, a, b };

    std::string path;                    // as given
    Sides sides = Sides::both;           // "system", "a", "b"
    std::string inside;                  // the key in that table, with its entry: "force.spring.stiffness_N_per_m"
    std::optional<std::size_t> element;  // index in an array
    std::string label;                   // of an axis: "mass m₂, kg"
    Bounds bounds;
    bool is_whole = false;  // the number of links
    bool is_step = false;   // step_s
    /// Whether pendulums that differ in it have the same equations and step size.
    bool keeps_method = true;

    /// Throws Error (exit 2) at the table's `key` if the preset has no such number, or the number does not apply.
    NumericKey(const TomlReader& table, std::string_view key, std::string path, const Preset& preset);

    /// The value that is set: for the number of links a whole number, for the step size one that divides a sample.
    Quad taken(const Quad& value, const Preset& preset) const;
    /// Sets the value; if the key applies to both sides, side b gets `difference` more.
    void set(Preset& preset, const Quad& value, const Quad& difference) const;
};

/// Linear interpolation between chains that only differ in numbers.
SideSpec between(SideSpec from, SideSpec to, const Quad& share);

}  // namespace doppel

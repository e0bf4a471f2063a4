#pragma once

#include "scene/toml_reader.hpp"

#include <optional>
#include <string>

namespace doppel {

/// A number of a preset that sweeps and maps vary, by its place: "system.gravity_m_per_s2", "b.mass_kg[1]" (elements
/// count from 0; without a number all of them), "system.force.spring.stiffness_N_per_m" (an entry by its name, or by its
/// kind where there is one of that kind).
struct NumericKey {
    enum class Sides { both, a, b };

    std::string path;                    // as it was given
    Sides sides = Sides::both;           // "system", "a", "b"
    std::string inside;                  // the key in that table, with its entry: "force.spring.stiffness_N_per_m"
    std::optional<std::size_t> element;  // of an array
    std::string label;                   // of an axis: "mass m₂, kg"
    Bounds bounds;
    bool is_whole = false;  // links
    bool is_step = false;   // step_s
    /// Whether pendulums that differ in it have the same equations and the same steps.
    bool keeps_method = true;

    /// Throws Error (exit 2), of the table's `key`, where the preset has no such number or it does not count.
    NumericKey(const TomlReader& table, std::string_view key, std::string path, const Preset& preset);

    /// What is put in place: of a number of links a whole one, of a step one that divides a sample.
    Quad taken(const Quad& value, const Preset& preset) const;
    /// Puts the value in place: of side b `difference` more where it is a number of both.
    void set(Preset& preset, const Quad& value, const Quad& difference) const;
};

/// Of chains that differ in numbers alone: each number that share of the way from one to the other.
SideSpec between(SideSpec from, SideSpec to, const Quad& share);

}  // namespace doppel

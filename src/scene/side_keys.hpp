#pragma once

#include "scene/preset_fields.hpp"

#include <fmt/format.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

struct Scene;

struct SideKey {
    std::string place;               // its entry, "spring 1", or "pivot"; empty: the side itself
    std::string_view key, unit;      // an empty `key` stands for the existence of the entry
    std::string caption = {};        // name in captions
    std::vector<Quad> numbers = {};  // with all their decimals
    std::string text = {};           // TOML, if it has no such numbers
    bool counts = true;              // false if the value is the same as not given
    bool is_of_links = false;        // one number per link, without a symbol
    bool is_of_part = false;         // of a constraint, a spring or an attraction

    /// "spring 1 stiffness_N_per_m"
    std::string name() const { return fmt::format("{}{}{}", place, place.empty() || key.empty() ? "" : " ", key); }
};

/// A key in which two sides differ, with its value on each; nothing for a side without it.
struct KeyDifference {
    std::optional<SideKey> a, b;

    const SideKey& any() const { return a ? *a : *b; }
    /// The caption for side b, or side a: "spring 1 stiffness 2 N/m", "no spring 1".
    std::string words(bool of_b) const;
};

/// Compares all keys that decide the motion of a side: system, forces, integration.
std::vector<KeyDifference> differing_keys(const SideSpec& a, const SideSpec& b);

/// Throws Error (exit 2) if the difference of the sides is lost in their precision: a number of any key, the whole
/// system, or the attraction of a droplet compared with gravity.
void check_difference(const Scene& scene);

/// The numbers of a side's member, if it has such a type: none for an optional one that is not given, unless `is_put`
/// creates it.
std::optional<std::span<Quad>> numbers_of(const KeyMember& member, bool is_put = false);

/// The name of a key in captions: "stiffness" for "stiffness_N_per_m".
std::string caption_of(const Field& field);

}  // namespace doppel

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

/// A key of a side, with its value. Captions are made of these rows.
struct SideKey {
    std::string place;                             // its entry, "spring 1", or "pivot"; empty: the side itself
    std::string_view key, unit = {}, symbol = {};  // an empty `key` stands for the existence of the entry
    std::string caption = {};                      // name in captions; empty if the value says enough
    std::vector<Quad> numbers = {};                // with all their decimals
    std::string text = {};  // the value, if it has no such numbers; of an entry, its numbers in the words of captions
    bool counts = true;     // false if the value is the same as not given
    bool is_of_links = false;  // one number per link
    bool is_setting = false;   // of the computation, not of the system
    bool is_default = false;   // a setting that captions only name beside another one

    /// "spring 1 stiffness_N_per_m"
    std::string name() const { return fmt::format("{}{}{}", place, place.empty() || key.empty() ? "" : " ", key); }
};

/// All keys that decide the motion of a side: system, forces, integration.
std::vector<SideKey> keys_of(SideSpec side);

/// A key with its value on each side; nothing for a side without it.
struct KeyPair {
    std::optional<SideKey> a, b;

    const SideKey& any() const { return a ? *a : *b; }
    bool differs() const;
    /// Whether both sides have it, with numbers.
    bool has_numbers() const { return a && b && !a->numbers.empty() && !b->numbers.empty(); }
};

/// Keys of both sides, without those of an entry that only one side has: it is a pair itself.
std::vector<KeyPair> paired(std::vector<SideKey> a, std::vector<SideKey> b);
/// The pairs that differ.
std::vector<KeyPair> differing_keys(const SideSpec& a, const SideSpec& b);

/// Whether both sides are the same system with the same release and integration: they move identically.
bool are_one(const Scene& scene);
/// A warning if this is so, and the scene is one of a pair.
std::optional<std::string> no_difference(const Scene& scene);

/// Throws Error (exit 2) if the difference of the sides is lost in their precision: a number of any key, the whole
/// system, or the attraction of a droplet compared with gravity.
void check_difference(const Scene& scene);

/// Whether all are the same number; not if there is none.
bool are_equal(std::span<const Quad> numbers);

/// The numbers of a side's member, if it has such a type: none for an optional one that is not given, unless `is_put`
/// creates it.
std::optional<std::span<Quad>> numbers_of(const KeyMember& member, bool is_put = false);

/// The name of a key in captions: "stiffness" for "stiffness_N_per_m".
std::string caption_of(const Field& field);

}  // namespace doppel

#pragma once

#include "scene/member.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// One key of a side, with what it holds.
struct SideKey {
    std::string place;               // the entry that has it, "spring 1", or "pivot"; empty: the side itself
    std::string_view key, unit;      // without `key`: that there is such an entry
    std::string caption = {};        // what captions call it
    std::vector<Quad> numbers = {};  // which mean all their decimals
    std::string text = {};           // TOML, where it holds no such numbers
    bool counts = true;              // false where it is as good as not given
    bool is_of_links = false;        // one number a link, without a symbol of its own
    bool is_of_part = false;         // of a constraint, a spring or an attraction

    /// "spring 1 stiffness_N_per_m"
    std::string name() const;
};

/// A key that sets two sides apart, on each of them; nothing where a side has no such key.
struct KeyDifference {
    std::optional<SideKey> a, b;

    const SideKey& any() const { return a ? *a : *b; }
    /// As captions tell it of side b, or of side a: "spring 1 stiffness 2 N/m", "no spring 1".
    std::string words(bool of_b) const;
};

/// By all keys that decide how sides move: what hangs, what acts on it, how it is integrated.
std::vector<KeyDifference> differing_keys(const SideSpec& a, const SideSpec& b);

/// The numbers that a member of a side holds, where it is of such a type: none of an optional one that is not given;
/// `is_put` gives it first.
std::optional<std::span<Quad>> numbers_of(const KeyMember& member, bool is_put = false);

/// What captions call a key: "stiffness" of "stiffness_N_per_m".
std::string caption_of(const Field& field);

}  // namespace doppel

#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace doppel {

/// The range of a key's numbers.
struct Bounds {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    double low = -infinity, high = infinity;
    bool is_open = false;                  // excludes `low`
    std::string_view zero = {}, why = {};  // meaning of 0; reason for the bounds

    bool has_low() const { return low > -infinity; }
    bool has_high() const { return high < infinity; }
};
inline constexpr Bounds positive{.low = 0, .is_open = true}, not_negative{.low = 0};
constexpr Bounds from_to(double low, double high, std::string_view zero = {}) {
    return {.low = low, .high = high, .zero = zero};
}
/// For angles, deg.
inline constexpr Bounds angle_bounds{.low = -1e6, .high = 1e6, .why = "beyond, rounding hides the motion"};

/// The most letters in one drawn text, and the most texts in a list.
inline constexpr std::size_t max_letters = 1000, max_texts = 20;

/// The condition under which a key applies.
struct Condition {
    bool applies = true;
    std::string error = {};  // error if the key does not apply; if empty, the key is read but not written
    bool drops = false;      // the command line excludes the key: then the preset's value is ignored without an error
    std::string_view beside = {};  // the key that decides, if it is one key
};

/// `absent` of a required key whose reader reports it.
inline constexpr std::string_view must_be_given = "must be given";

/// One key of a table. Lists of fields (preset_fields.cpp, and those of figure kinds) are used by the reader, the
/// resolved preset, the JSON schema and docs/presets.md. Type and default are those of the member that a list pairs
/// with the field.
struct Field {
    std::string_view key, help;
    std::string_view unit = {};
    Bounds bounds = {};
    std::string_view absent = {};  // meaning of an optional key that is not given
    Condition only = {};
    std::string_view each = {};                    // for arrays: "one per link"
    std::span<const std::string_view> names = {};  // choices of a text, or of the texts in a list
    std::string_view needed_by = {};               // kind of entry that requires the key
    bool is_drawn = false;                         // shown in pictures: at most `max_letters`, all of them in the font
    std::size_t maximum = 0;                       // for arrays of 1 or more numbers: the most
    std::string_view pattern = {};                 // regular expression of a text, for the schema
    std::optional<Bounds> otherwise = {};          // the widest bounds, if `bounds` depend on other keys
    std::string_view caption = {};                 // name in pictures; the key without its unit if not given
    std::string_view symbol = {};                  // "θ" for numbers that captions write as θ₁, θ₂
};

/// The names of an enumeration's values in presets, in the order of the values.
template <class Choice>
inline constexpr auto names_of = nullptr;

template <class Choice>
requires std::is_enum_v<Choice>
constexpr std::string_view name_of(Choice choice) {
    return names_of<Choice>[static_cast<std::size_t>(choice)];
}

/// The value with this name, which must be one of its names.
template <class Choice>
requires std::is_enum_v<Choice>
constexpr Choice value_named(std::string_view name) {
    return static_cast<Choice>(std::find(names_of<Choice>.begin(), names_of<Choice>.end(), name) -
                               names_of<Choice>.begin());
}

template <class T>
constexpr bool is_optional = false;
template <class T>
constexpr bool is_optional<std::optional<T>> = true;

}  // namespace doppel

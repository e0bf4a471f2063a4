#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace doppel {

/// The numbers that a key takes.
struct Bounds {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    double low = -infinity, high = infinity;
    bool is_open = false;                  // without `low` itself
    std::string_view zero = {}, why = {};  // what 0 means; why there are bounds
    bool is_positive = false;              // numbers ≤ 0 are refused as such, whatever `low` is

    bool has_low() const { return low > -infinity; }
    bool has_high() const { return high < infinity; }
};
inline constexpr Bounds positive{.low = 0, .is_open = true}, not_negative{.low = 0};
constexpr Bounds from_to(double low, double high, std::string_view zero = {}) {
    return {.low = low, .high = high, .zero = zero};
}
/// Of an angle, deg.
inline constexpr Bounds angle_bounds{.low = -1e6, .high = 1e6, .why = "beyond, rounding hides the motion"};

/// What pictures show of one text, and how many texts of one list.
inline constexpr std::size_t most_letters = 1000, most_texts = 20;

/// The values beside which a key counts.
struct Only {
    bool holds = true;
    std::string fault = {};        // the error for a key that does not count; where empty, it is read and not written
    bool drops = false;            // the command line chose otherwise: what the file says is no error
    bool hides = false;            // the table has no such key where it does not count
    std::string_view beside = {};  // the key that decides, where one does
};

/// One key of a table. Lists of fields (preset_fields.cpp, and those of each kind of figure) serve the reader, the
/// resolved preset, its JSON schema and docs/presets.md; type and default are those of the member that a list pairs it with.
struct Field {
    std::string_view key, help;
    std::string_view unit = {};
    Bounds bounds = {};
    std::string_view absent = {};  // what holds where an optional key is not given
    Only only = {};
    std::string_view each = {};                    // what the numbers of an array are: "one a link"
    std::span<const std::string_view> names = {};  // of a string, or of those of a list: the choices
    std::string_view needed_by = {};               // an entry of this kind must have it
    bool is_drawn = false;                         // pictures show it: of letters that the font has, not too many
    std::size_t most = 0;                          // numbers of an array that may have 1 or more
    std::span<const std::string_view> known = {};  // names that it takes, where not the reader checks them
    std::string_view pattern = {};                 // of a string's form: a regular expression, for the schema
    std::optional<Bounds> otherwise = {};          // the widest that it takes, where other keys decide on `bounds`
    std::string_view caption = {};                 // what pictures call it; the key without its unit where not given
    std::string_view symbol = {};                  // "θ" of numbers that captions write as θ₁, θ₂
};

/// The names of an enumeration's values in presets, in their order.
template <class Choice>
inline constexpr auto names_of = nullptr;

template <class Choice>
requires std::is_enum_v<Choice>
constexpr std::string_view name_of(Choice choice) {
    return names_of<Choice>[static_cast<std::size_t>(choice)];
}

/// The value of that name, which is one of its names.
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

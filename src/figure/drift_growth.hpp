#pragma once

#include <span>
#include <string_view>

namespace doppel {

/// How an error grows in time.
struct Growth {
    enum class Kind { bounded, root, linear, steeper, breakdown };
    Kind kind = Kind::bounded;
    double exponent = 0;     // of t, fitted to the last two decades; 0 where there is nothing to fit
    double doubling_s = 0;   // just before a breakdown; NaN without one, or where it comes at once
    double broken_at_s = 0;  // NaN without a breakdown
};

/// From the errors at rising times, s; those that are none, or 0, do not count. `broken_at_s` = when the method broke
/// down, or NaN.
Growth growth_of(std::span<const double> times_s, std::span<const double> errors, double broken_at_s);

/// "stays bounded", "grows linearly" …
std::string_view growth_words(Growth::Kind kind);

}  // namespace doppel

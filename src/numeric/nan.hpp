#pragma once

#include <limits>

namespace doppel {

/// What stands where a number could not be had.
inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

}  // namespace doppel

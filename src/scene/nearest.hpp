#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace doppel {

/// The candidate that is a slip of the hand away from `word`, if there is one.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace doppel

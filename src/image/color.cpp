#include "image/color.hpp"

#include <charconv>

namespace doppel {

std::optional<Color> parse_color(std::string_view text) {
    if (text.size() != 7 || text.front() != '#') return std::nullopt;
    unsigned hex = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data() + 1, end, hex, 16);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    return rgb(hex);
}

}  // namespace doppel

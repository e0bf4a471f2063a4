#include "image/color.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace doppel {

std::optional<Color> parse_color(std::string_view text) {
    if (text.size() != 7 || text.front() != '#') return std::nullopt;
    unsigned hex = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data() + 1, end, hex, 16);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    return rgb(hex);
}

namespace {

constexpr std::array<unsigned, 33> stops{
    0x1c0836, 0x210d42, 0x25124f, 0x2a175b, 0x2e1e68, 0x312673, 0x312f7d, 0x303987, 0x2d438f, 0x2a4d95, 0x29579a,
    0x28619c, 0x296a9c, 0x2a749c, 0x2b7d9c, 0x2b869c, 0x29909c, 0x28999c, 0x2aa29a, 0x32ab98, 0x3eb393, 0x4bba8d,
    0x59c185, 0x69c87d, 0x7ace74, 0x8cd46c, 0xa0d962, 0xb5dd57, 0xc8e14f, 0xdae650, 0xe9eb62, 0xf4f079, 0xfff48d};

}  // namespace

Color map_color(double share) {
    constexpr double last = stops.size() - 1;
    const double at = std::fmin(std::fmax(share, 0.0), 1.0) * last;
    const auto i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
    return mixed(rgb(stops[i]), rgb(stops[i + 1]), static_cast<float>(at - static_cast<double>(i)));
}

}  // namespace doppel

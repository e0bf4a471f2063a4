#include "image/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace doppel {

Rect united(const Rect& a, const Rect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

Rect intersection(const Rect& a, const Rect& b) {
    return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

bool Picture::is_opaque() const {
    for (std::size_t i = 3; i < rgba.size(); i += 4)
        if (rgba[i] != 255) return false;
    return true;
}

void matte(const Picture& black, const Picture& white, const Rect& within, Picture& into) {
    for (int y = within.top; y < within.bottom; ++y)
        for (int x = within.left; x < within.right; ++x) {
            const auto *on_black = black.at(x, y), *on_white = white.at(x, y);
            auto* pixel = into.at(x, y);
            // on black the result is a·c, on white a·c + (1 − a)·255
            int lost = 255;
            for (int k = 0; k < 3; ++k) lost = std::min(lost, std::max(on_white[k] - on_black[k], 0));
            const int opacity = 255 - lost;
            pixel[3] = static_cast<std::uint8_t>(opacity);
            for (int k = 0; k < 3; ++k)
                pixel[k] =
                    opacity == 0
                        ? 0
                        : static_cast<std::uint8_t>(std::min(255, (2 * 255 * on_black[k] + opacity) / (2 * opacity)));
        }
}

namespace {

// IEC 61966-2-1, both directions, on 0…1.
double to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
double to_srgb(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

const std::array<double, 256>& linear_of_bytes() {
    static const auto table = [] {
        std::array<double, 256> linear;
        for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = to_linear(static_cast<double>(i) / 255);
        return linear;
    }();
    return table;
}

}  // namespace

Picture halved(const Picture& picture) {
    const auto [width, height] = picture.size;
    const auto& linear = linear_of_bytes();
    Picture small({(width + 1) / 2, (height + 1) / 2});
    for (int y = 0; y < small.size.height; ++y)
        for (int x = 0; x < small.size.width; ++x) {
            std::array<double, 4> mean{};  // premultiplied linear colours, and opacity
            for (int column = 2 * x; column < std::min(2 * x + 2, width); ++column) {
                std::array<double, 4> sum{};
                for (int row = 2 * y; row < std::min(2 * y + 2, height); ++row) {
                    const std::uint8_t* pixel = picture.at(column, row);
                    const double weight = 0.25 * pixel[3] / 255;
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * linear[pixel[c]];
                    sum[3] += weight;
                }
                for (std::size_t c = 0; c < 4; ++c) mean[c] += sum[c];
            }
            std::uint8_t* pixel = small.at(x, y);
            for (std::size_t c = 0; c < 3; ++c) pixel[c] = mean[3] > 0 ? byte_of(to_srgb(mean[c] / mean[3])) : 0;
            pixel[3] = byte_of(mean[3]);
        }
    return small;
}

Picture contact_sheet(std::span<const Picture> pictures, int columns, int gap_px, Color background) {
    const auto [width, height] = pictures.front().size;
    const int count = static_cast<int>(pictures.size()), across = std::min(columns, count);
    const int rows = (count + columns - 1) / columns;
    Picture sheet({gap_px + across * (width + gap_px), gap_px + rows * (height + gap_px)});
    const auto fill = bytes_of(background);
    for (std::size_t i = 0; i < sheet.rgba.size(); ++i) sheet.rgba[i] = fill[i % 4];
    for (int k = 0; k < count; ++k) {
        const Picture& picture = pictures[static_cast<std::size_t>(k)];
        const int left = gap_px + k % columns * (width + gap_px), top = gap_px + k / columns * (height + gap_px);
        for (int row = 0; row < height; ++row)
            std::copy_n(picture.at(0, row), std::size_t{4} * width, sheet.at(left, top + row));
    }
    return sheet;
}

std::string hexadecimal(const Color& color) {
    const auto [r, g, b, a] = bytes_of(color);
    return fmt::format("#{:02x}{:02x}{:02x}", r, g, b) + (a == 255 ? "" : fmt::format("{:02x}", a));
}

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

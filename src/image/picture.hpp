#pragma once

#include "image/color.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

struct Size {
    int width = 0, height = 0;  // px
    friend constexpr bool operator==(const Size&, const Size&) = default;
};

/// A rectangle of whole pixels, half open: left ≤ x < right, top ≤ y < bottom; y points down.
struct Rect {
    int left = 0, top = 0, right = 0, bottom = 0;

    constexpr bool empty() const { return right <= left || bottom <= top; }
    constexpr long area() const { return long{right - left} * (bottom - top); }
    friend constexpr bool operator==(const Rect&, const Rect&) = default;
};

constexpr Rect all_of(Size size) {
    return {0, 0, size.width, size.height};
}
/// The smallest rectangle that contains both.
Rect united(const Rect& a, const Rect& b);
/// The common part of both; empty() if they do not overlap.
Rect intersection(const Rect& a, const Rect& b);

/// An 8-bit RGBA image: rows from the top down, no padding, sRGB.
struct Picture {
    Size size;
    std::vector<std::uint8_t> rgba;  // 4 · width · height

    Picture() = default;
    explicit Picture(Size s) : size(s), rgba(std::size_t{4} * s.width * s.height) {}

    const std::uint8_t* at(int x, int y) const { return &rgba[(std::size_t(y) * size.width + x) * 4]; }
    std::uint8_t* at(int x, int y) { return &rgba[(std::size_t(y) * size.width + x) * 4]; }

    /// Whether all pixels are opaque.
    bool is_opaque() const;
};

/// Metadata of a file: pairs of key and text, UTF-8. All formats store "title", "comment", "description", "artist",
/// "copyright" and "date". All but mp4 (where libav writes its own name) also store "encoder".
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Recovers colours and opacity (not premultiplied) within the rectangle, from the same picture drawn on black and on
/// white; all have one size. Laid over black in sRGB, the result is exact; over white, where the channels agree on the
/// opacity: edges that were blended in linear light become slightly darker there.
void matte(const Picture& black, const Picture& white, const Rect& within, Picture& into);

/// The picture at half the size. Each new pixel is the mean of the four that it covers, in linear light, weighted by
/// opacity; beyond an odd side they are transparent.
Picture halved(const Picture& picture);

/// Pictures of one size, at least one, in rows of `columns`, with `gap_px` of background between and around them. The
/// last row may be incomplete.
Picture contact_sheet(std::span<const Picture> pictures, int columns, int gap_px, Color background);

}  // namespace doppel

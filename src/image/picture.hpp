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

/// Whole pixels, half open: left ≤ x < right, top ≤ y < bottom; y points down.
struct Rect {
    int left = 0, top = 0, right = 0, bottom = 0;

    constexpr bool empty() const { return right <= left || bottom <= top; }
    friend constexpr bool operator==(const Rect&, const Rect&) = default;
};

constexpr Rect all_of(Size size) {
    return {0, 0, size.width, size.height};
}
/// The smallest rectangle that holds both.
Rect united(const Rect& a, const Rect& b);
/// What both cover; empty() where they do not meet.
Rect intersection(const Rect& a, const Rect& b);

/// An 8-bit RGBA image: rows from the top down, no padding, sRGB.
struct Picture {
    Size size;
    std::vector<std::uint8_t> rgba;  // 4 · width · height

    Picture() = default;
    explicit Picture(Size s) : size(s), rgba(std::size_t{4} * s.width * s.height) {}

    const std::uint8_t* at(int x, int y) const { return &rgba[(std::size_t(y) * size.width + x) * 4]; }
    std::uint8_t* at(int x, int y) { return &rgba[(std::size_t(y) * size.width + x) * 4]; }

    /// Whether nothing shines through.
    bool is_opaque() const;
};

/// A file's metadata: keys and texts, UTF-8. Every format stores "title", "comment", "description", "artist",
/// "copyright" and "date"; all but mp4 (where libav names itself) also "encoder", the program that made the file.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Undoes a background: from the same picture on black and on white, within the rectangle, the colours with their
/// opacity (not premultiplied) that give both back where a viewer lays them over it in sRGB. Exact on black, and on
/// white where all channels agree on the opacity; edges that were blended in linear light come out a little darker
/// there. All of one size.
void matte(const Picture& black, const Picture& white, const Rect& within, Picture& into);

/// The picture made smaller: each new pixel is the mean, in linear light, of what it covers of the old ones, parts of
/// pixels included, each weighted by its opacity. Throws Error (exit 2) where a side would grow, or be none.
Picture downscaled(const Picture& picture, Size size);

/// Pictures of one size in rows of `columns`, `gap_px` of background between them and around all; in the last row
/// some may be missing. Throws Error (exit 2) where there is none, their sizes differ, or columns < 1 or gap_px < 0.
Picture contact_sheet(std::span<const Picture> pictures, int columns, int gap_px, Color background);

}  // namespace doppel

#pragma once

#include <cstddef>
#include <cstdint>
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
Rect common(const Rect& a, const Rect& b);

/// An 8-bit RGBA image: rows from the top down, no padding, sRGB.
struct Picture {
    Size size;
    std::vector<std::uint8_t> rgba;  // 4 · width · height

    Picture() = default;
    explicit Picture(Size s) : size(s), rgba(std::size_t{4} * s.width * s.height) {}

    const std::uint8_t* at(int x, int y) const { return &rgba[(std::size_t(y) * size.width + x) * 4]; }
    std::uint8_t* at(int x, int y) { return &rgba[(std::size_t(y) * size.width + x) * 4]; }
};

}  // namespace doppel

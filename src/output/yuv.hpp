#pragma once

#include "picture/picture.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace doppel {

/// A rectangle of a picture as video codecs take it: 4:2:0, BT.709, limited range (Y 16…235, Cb and Cr 16…240). Luma
/// has a sample a pixel; chroma has one for 2×2 pixels, their mean, sited in the centre of the four.
struct YuvPart {
    Rect area;                                // px, all edges even
    std::unique_ptr<std::uint8_t[]> samples;  // Y, then Cb, then Cr; rows from the top down, no padding

    explicit YuvPart(const Rect& a);

    int width() const { return area.right - area.left; }
    int height() const { return area.bottom - area.top; }
    std::uint8_t* y() const { return samples.get(); }
    std::uint8_t* cb() const { return y() + std::size_t(width()) * height(); }
    std::uint8_t* cr() const { return cb() + std::size_t(width() / 2) * (height() / 2); }
};

/// The smallest rectangle with even edges that holds `area`, inside a picture of even size.
Rect even(const Rect& area, Size picture);

/// Converts even(area) of a picture of even size. A sample depends on the pixels below it alone: all of a picture, or
/// any cover of it by areas, gives the same bytes; so does every width of SIMD.
YuvPart convert(const Picture& picture, const Rect& area);

}  // namespace doppel

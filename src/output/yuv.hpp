#pragma once

#include "picture/picture.hpp"

#include <cstdint>
#include <vector>

namespace doppel {

/// A picture as video codecs take it: 4:2:0, BT.709, limited range (Y 16…235, Cb and Cr 16…240). Rows of a plane are
/// `stride` bytes apart; chroma planes have half the width and height, sited between the two luma columns' … (left, as MPEG-2).
struct YuvPicture {
    Size size;  // px, even
    std::vector<std::uint8_t> y, cb, cr;

    explicit YuvPicture(Size s);
};

/// Converts the part of `picture` inside `area` (widened to even pixels); the rest of `yuv` stays as it is.
/// Converting all of a picture, or any cover of it by areas, gives the same bytes.
void convert(const Picture& picture, const Rect& area, YuvPicture& yuv);

}  // namespace doppel

#pragma once

#include "image/picture.hpp"

extern "C" {
#include <libavutil/pixfmt.h>
}

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace doppel {

// Conversion of pictures to libav's pixel formats RGB24, RGBA, YUV420P, YUV444P, YUV420P10LE and YUVA420P. Y, Cb and Cr
// are BT.709, limited range: with 8 bits Y is 16…235, Cb and Cr 16…240; with 10 bits four times that. In 4:2:0 a chroma
// sample is the mean of 2×2 pixels, located in their centre. Alpha is unchanged.

/// The place of a rectangle of a picture in one plane.
struct PlaneArea {
    int offset, row_bytes;  // of a row, bytes
    int top, rows;
};
PlaneArea plane_area(AVPixelFormat format, int plane, const Rect& area);

/// Bytes of one rectangle, or of several, in all planes.
std::size_t byte_count(AVPixelFormat format, const Rect& area);
std::size_t byte_count(AVPixelFormat format, const std::vector<Rect>& areas);

/// The smallest rectangle around `area` that shares no sample with pixels outside: even edges in 4:2:0. It is cut off
/// at the edges of the picture, whose sides are even in 4:2:0.
Rect aligned(AVPixelFormat format, const Rect& area, Size picture);

/// Converts an aligned rectangle: plane after plane, rows from the top down, no padding. A sample depends on its own
/// pixels only. So a whole picture and its areas one by one give the same bytes, at every SIMD width. (swscale filters
/// chroma over more pixels, and cannot convert areas.)
void convert(const Picture& picture, const Rect& area, AVPixelFormat format, std::uint8_t* to);

/// Uninitialised bytes; their memory is reused.
class Buffer {
public:
    /// Room for `count` bytes with undefined contents.
    std::uint8_t* make_room(std::size_t count) {
        if (count > capacity_) {
            bytes_ = std::make_unique_for_overwrite<std::uint8_t[]>(count);
            capacity_ = count;
        }
        return bytes_.get();
    }
    const std::uint8_t* data() const { return bytes_.get(); }
    std::uint8_t* data() { return bytes_.get(); }

private:
    std::unique_ptr<std::uint8_t[]> bytes_;
    std::size_t capacity_ = 0;
};

/// The changed areas of a picture, converted, one after the other.
struct SampledAreas {
    std::vector<Rect> areas;  // aligned
    Buffer bytes;
};

void convert(const Picture& picture, const std::vector<Rect>& changed, AVPixelFormat format, SampledAreas& to);

}  // namespace doppel

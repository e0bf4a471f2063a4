#pragma once

#include "image/picture.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace doppel {

/// Pictures as encoders take them.
///     yuv…   BT.709, limited range: of 8 bits Y is 16…235, Cb and Cr are 16…240; of 10 bits four times that, two bytes
///            a sample (little endian)
///     …420   chroma has one sample for 2×2 pixels, their mean, sited in the centre of the four
///     …444   and here one for each
///     yuva…  a plane of alpha beside, as it is
///     rgb    8 bits, one plane, as they are; rgba with alpha
enum class Samples { yuv420, yuv444, yuv420_10, yuva420, rgb, rgba };

int plane_count(Samples samples);

/// Where a rectangle of a picture lies in one of its planes.
struct PlaneArea {
    int offset, row_bytes;  // of a row, bytes
    int top, rows;
};
PlaneArea plane_area(Samples samples, int plane, const Rect& area);

/// Of a rectangle, all planes.
std::size_t byte_count(Samples samples, const Rect& area);

/// The smallest rectangle that holds `area` and has samples of its own: even edges in 4:2:0. What lies outside the
/// picture (whose sides are even then) is cut off.
Rect aligned(Samples samples, const Rect& area, Size picture);

/// Converts an aligned rectangle: plane after plane, rows from the top down, no padding. A sample depends on the pixels
/// below it alone: all of a picture, or any cover of it by areas, gives the same bytes; so does every width of SIMD.
void convert(const Picture& picture, const Rect& area, Samples samples, std::uint8_t* to);

/// Bytes to be filled; they keep their memory from one use to the next.
class Buffer {
public:
    /// Room for `count` bytes; what was in it is forgotten.
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

/// What changed in a picture, converted: each area's bytes follow those of the area before.
struct SampledAreas {
    std::vector<Rect> areas;  // aligned
    Buffer bytes;
};

/// Converts what changed into `to`, which keeps its memory.
void convert(const Picture& picture, const std::vector<Rect>& changed, Samples samples, SampledAreas& to);

}  // namespace doppel

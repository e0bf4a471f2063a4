#pragma once

#include "image/picture.hpp"

#include <array>
#include <string>

namespace doppel {

/// How two pictures of one size differ, and whether the golden policy accepts it. Small differences at a few pixels, as
/// between drivers or SIMD widths, pass. A shift by a pixel, another background, gamma or opacity fail.
struct GoldenVerdict {
    long differing = 0;            // pixels that differ
    long strong = 0;               // pixels that differ by more than 3/255 in any channel
    int largest = 0;               // greatest difference of a channel, /255
    double worst_tile = 0;         // greatest mean difference over a 32×32 tile, /255
    std::array<double, 4> mean{};  // signed mean of each channel, actual − expected, /255
    bool passes = true;
    std::string why;  // the limits exceeded, in words; empty if the pictures pass
};

/// Throws Error (exit 1) if the sizes differ.
GoldenVerdict compare_golden(const Picture& expected, const Picture& actual);

/// The difference of two pictures of one size × 16, opaque; a difference in opacity alone is grey.
Picture amplified_difference(const Picture& expected, const Picture& actual);

/// Expected, actual and amplified difference side by side, all opaque.
Picture difference_picture(const Picture& expected, const Picture& actual);

}  // namespace doppel

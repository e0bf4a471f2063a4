#pragma once

#include "image/picture.hpp"

#include <array>
#include <string>

namespace doppel {

/// How two pictures of one size differ, and whether the golden policy lets it pass. Drivers and SIMD widths move a few
/// pixels by a few levels and pass; a shift by a pixel, another background, gamma or opacity does not. Opacity is a
/// channel like the three colours.
struct GoldenVerdict {
    long differing = 0;            // pixels that are not the same
    long strong = 0;               // pixels that differ by more than 3/255 in a channel
    int largest = 0;               // greatest difference of a channel, /255
    double worst_tile = 0;         // greatest mean difference over a 32×32 tile, /255
    std::array<double, 4> mean{};  // signed mean of each channel, actual − expected, /255
    bool passes = true;
    std::string why;  // the rules broken, in words; empty if it passes
};

/// Throws Error (exit 1) where the sizes differ.
GoldenVerdict compare_golden(const Picture& expected, const Picture& actual);

/// The difference of two pictures of one size × 16, opaque; a difference in opacity alone is grey.
Picture amplified_difference(const Picture& expected, const Picture& actual);

/// Expected, actual and amplified difference side by side, all opaque.
Picture difference_picture(const Picture& expected, const Picture& actual);

}  // namespace doppel

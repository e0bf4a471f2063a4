#pragma once

#include "image/picture.hpp"

#include <array>
#include <cstdint>
#include <memory>

struct liq_attr;
struct liq_histogram;
struct liq_result;

namespace doppel {

/// The 255 colours that stand best for all that was counted, by libimagequant (median cut, refined by k-means;
/// distances as the eye has them). A pixel becomes the colour nearest to it, whatever is around: no dithering, which
/// would flicker where pictures move and cost the size of a noisy one.
class Palette {
public:
    Palette();
    ~Palette();
    Palette(const Palette&) = delete;
    Palette& operator=(const Palette&) = delete;

    /// Counts the pixels of a rectangle: RGBA, opaque, rows from the top down, no padding.
    void count(const std::uint8_t* rgba, Size size);
    /// Chooses; nothing can be counted after.
    void choose();
    /// Entry 255 is transparent black and stands for no pixel.
    std::array<std::uint32_t, 256> argb() const;
    /// The number of the colour of each pixel of such a rectangle.
    void look_up(const std::uint8_t* rgba, Size size, std::uint8_t* index);

private:
    struct Free {
        void operator()(liq_attr* attributes) const;
        void operator()(liq_histogram* histogram) const;
        void operator()(liq_result* result) const;
    };
    std::unique_ptr<liq_attr, Free> attributes_;
    std::unique_ptr<liq_histogram, Free> histogram_;
    std::unique_ptr<liq_result, Free> result_;
};

}  // namespace doppel

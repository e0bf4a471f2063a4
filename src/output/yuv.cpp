#include "output/yuv.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

// The loops are compiled twice, and the processor chooses when the program starts. Sanitizers cannot work that early.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && !defined(DOPPEL_SANITIZE)
#define DOPPEL_WIDEST_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define DOPPEL_WIDEST_SIMD
#endif

namespace doppel {
namespace {

static_assert(std::endian::native == std::endian::little, "a pixel is read as one word, red in its lowest byte");

// ITU-R BT.709-6, items 3.2 to 3.4, on R, G, B of 0…255:
//
//     E  = Kr R + Kg G + Kb B
//     Y  =  16 + 219/255 E
//     Cb = 128 + 224/255 (B - E) / (2 (1 - Kb))
//     Cr = 128 + 224/255 (R - E) / (2 (1 - Kr))
constexpr double kr = 0.2126, kb = 0.0722;
constexpr double luma_range = 219.0 / 255.0, chroma_range = 224.0 / 255.0;

constexpr int fraction_bits = 16;
constexpr int fixed(double x) {
    return static_cast<int>(x * (1 << fraction_bits) + (x < 0.0 ? -0.5 : 0.5));
}

/// What a sample takes of each colour, in units of 2^-16.
struct Weights {
    int r, g, b;
};
// green takes the rest, so that a grey has exactly its luma, and no chroma
constexpr Weights with_green(int r, int b, int sum) {
    return {r, sum - r - b, b};
}
constexpr Weights to_y = with_green(fixed(luma_range * kr), fixed(luma_range* kb), fixed(luma_range));
constexpr Weights to_cb = with_green(fixed(-chroma_range * kr / (2 * (1 - kb))), fixed(chroma_range / 2), 0);
constexpr Weights to_cr = with_green(fixed(chroma_range / 2), fixed(-chroma_range* kb / (2 * (1 - kr))), 0);

/// offset + weights · (r, g, b), rounded; the colours are sums over 2^sum_bits pixels.
template <int offset, int sum_bits>
constexpr std::uint8_t sample(const Weights& weights, int r, int g, int b) {
    constexpr int bits = fraction_bits + sum_bits;
    constexpr int rounded_offset = (offset << bits) + (1 << (bits - 1));
    return static_cast<std::uint8_t>((weights.r * r + weights.g * g + weights.b * b + rounded_offset) >> bits);
}

template <class Word>
Word load(const std::uint8_t* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

DOPPEL_WIDEST_SIMD
void luma_row(const std::uint8_t* __restrict rgba, int width, std::uint8_t* __restrict y) {
    for (int i = 0; i < width; ++i) {
        const auto pixel = load<std::uint32_t>(rgba + 4 * i);
        y[i] = sample<16, 0>(to_y, pixel & 0xff, pixel >> 8 & 0xff, pixel >> 16 & 0xff);
    }
}

/// From two rows of pixels, one of each chroma.
DOPPEL_WIDEST_SIMD
void chroma_row(const std::uint8_t* __restrict upper, const std::uint8_t* __restrict lower, int width,
                std::uint8_t* __restrict cb, std::uint8_t* __restrict cr) {
    // two pixels at once in four lanes of 16 bits: R and B of both, then G and A of both
    constexpr std::uint64_t lanes = 0x00ff00ff00ff00ff;
    for (int i = 0; i < width / 2; ++i) {
        const auto above = load<std::uint64_t>(upper + 8 * i), below = load<std::uint64_t>(lower + 8 * i);
        const std::uint64_t red_blue = (above & lanes) + (below & lanes);
        const std::uint64_t green = (above >> 8 & lanes) + (below >> 8 & lanes);
        const auto red_blue_sum = static_cast<std::uint32_t>(red_blue + (red_blue >> 32));
        const auto green_sum = static_cast<std::uint32_t>(green + (green >> 32));
        const int r = red_blue_sum & 0xffff, g = green_sum & 0xffff, b = red_blue_sum >> 16;
        cb[i] = sample<128, 2>(to_cb, r, g, b);
        cr[i] = sample<128, 2>(to_cr, r, g, b);
    }
}

}  // namespace

YuvPart::YuvPart(const Rect& a)
    : area(a), samples(std::make_unique_for_overwrite<std::uint8_t[]>(std::size_t(width()) * height() * 3 / 2)) {}

Rect even(const Rect& area, Size picture) {
    return {std::max(area.left, 0) & ~1, std::max(area.top, 0) & ~1, std::min(area.right + 1, picture.width) & ~1,
            std::min(area.bottom + 1, picture.height) & ~1};
}

YuvPart convert(const Picture& picture, const Rect& area) {
    YuvPart part(even(area, picture.size));
    const int width = part.width(), left = part.area.left;
    for (int row = 0; row < part.height(); row += 2) {
        const std::uint8_t* upper = picture.at(left, part.area.top + row);
        const std::uint8_t* lower = picture.at(left, part.area.top + row + 1);
        std::uint8_t* y = part.y() + std::size_t(row) * width;
        const std::size_t chroma = std::size_t(row / 2) * (width / 2);
        luma_row(upper, width, y);
        luma_row(lower, width, y + width);
        chroma_row(upper, lower, width, part.cb() + chroma, part.cr() + chroma);
    }
    return part;
}

}  // namespace doppel

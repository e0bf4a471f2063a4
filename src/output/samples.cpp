#include "output/samples.hpp"

extern "C" {
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
}

#include <array>
#include <bit>
#include <cstring>

// The loops are compiled for two instruction sets; the processor decides at program start (too early for sanitizers).
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && !defined(DOPPEL_SANITIZE)
#define DOPPEL_WIDEST_SIMD __attribute__((target_clones("avx2", "default")))
#else
#define DOPPEL_WIDEST_SIMD
#endif
#define DOPPEL_INLINE [[gnu::always_inline]] inline

namespace doppel {
namespace {

/// Planes that are filled row by row.
struct Target {
    std::array<std::uint8_t*, 4> plane{};
    std::array<int, 4> stride{};  // bytes
    template <class Sample = std::uint8_t>
    Sample* row(std::size_t k, int number) const {
        return reinterpret_cast<Sample*>(plane[k] + std::ptrdiff_t{stride[k]} * number);
    }
};

static_assert(std::endian::native == std::endian::little, "a pixel is read as one word, red in its lowest byte");

// ITU-R BT.709-6, items 3.2 to 3.4, on R, G, B of 0…255, and s = 1 for 8 bits, 4 for 10:
//
//     E  = Kr R + Kg G + Kb B
//     Y  = s ( 16 + 219/255 E)
//     Cb = s (128 + 224/255 (B - E) / (2 (1 - Kb)))
//     Cr = s (128 + 224/255 (R - E) / (2 (1 - Kr)))
constexpr double kr = 0.2126, kb = 0.0722;
constexpr double luma_range = 219.0 / 255.0, chroma_range = 224.0 / 255.0;

constexpr int fraction_bits = 16;
constexpr int fixed(double x) {
    return static_cast<int>(x * (1 << fraction_bits) + (x < 0.0 ? -0.5 : 0.5));
}

/// The weight of each colour in a sample, in units of 2^-16.
struct Weights {
    int r, g, b;
};
// green completes the sum, so that greys have exact luma and zero chroma
constexpr Weights with_green(int r, int b, int sum) {
    return {r, sum - r - b, b};
}
/// The scale factor s of this sample type.
template <class Sample>
constexpr int scale = sizeof(Sample) == 1 ? 1 : 4;
template <int s>
constexpr Weights to_y = with_green(fixed(s* luma_range* kr), fixed(s* luma_range* kb), fixed(s* luma_range));
template <int s>
constexpr Weights to_cb = with_green(fixed(s * -chroma_range * kr / (2 * (1 - kb))), fixed(s* chroma_range / 2), 0);
template <int s>
constexpr Weights to_cr = with_green(fixed(s* chroma_range / 2), fixed(s * -chroma_range * kb / (2 * (1 - kr))), 0);

/// offset + weights · (r, g, b), rounded; the colours are sums over 2^sum_bits pixels.
template <class Sample, int offset, int sum_bits>
DOPPEL_INLINE constexpr Sample sample(const Weights& weights, int r, int g, int b) {
    constexpr int bits = fraction_bits + sum_bits;
    constexpr int rounded_offset = (scale<Sample> * offset << bits) + (1 << (bits - 1));
    return static_cast<Sample>((weights.r * r + weights.g * g + weights.b * b + rounded_offset) >> bits);
}

template <class Word>
DOPPEL_INLINE Word load(const std::uint8_t* bytes) {
    Word word;
    std::memcpy(&word, bytes, sizeof word);
    return word;
}

// Conversions of rows of RGBA pixels to rows of samples.

template <class Sample>
DOPPEL_INLINE void luma(const std::uint8_t* __restrict rgba, int width, Sample* __restrict y) {
    for (int i = 0; i < width; ++i) {
        const auto pixel = load<std::uint32_t>(rgba + 4 * i);
        y[i] = sample<Sample, 16, 0>(to_y<scale<Sample>>, pixel & 0xff, pixel >> 8 & 0xff, pixel >> 16 & 0xff);
    }
}

template <class Sample>
DOPPEL_INLINE void chroma_of_four(const std::uint8_t* __restrict upper, const std::uint8_t* __restrict lower, int width,
                                  Sample* __restrict cb, Sample* __restrict cr) {
    // two pixels at once in four lanes of 16 bits: R and B of both, then G and A of both
    constexpr std::uint64_t lanes = 0x00ff00ff00ff00ff;
    for (int i = 0; i < width / 2; ++i) {
        const auto above = load<std::uint64_t>(upper + 8 * i), below = load<std::uint64_t>(lower + 8 * i);
        const std::uint64_t red_blue = (above & lanes) + (below & lanes);
        const std::uint64_t green = (above >> 8 & lanes) + (below >> 8 & lanes);
        const auto red_blue_sum = static_cast<std::uint32_t>(red_blue + (red_blue >> 32));
        const auto green_sum = static_cast<std::uint32_t>(green + (green >> 32));
        const int r = red_blue_sum & 0xffff, g = green_sum & 0xffff, b = red_blue_sum >> 16;
        cb[i] = sample<Sample, 128, 2>(to_cb<scale<Sample>>, r, g, b);
        cr[i] = sample<Sample, 128, 2>(to_cr<scale<Sample>>, r, g, b);
    }
}

DOPPEL_INLINE void chroma_of_one(const std::uint8_t* __restrict rgba, int width, std::uint8_t* __restrict cb,
                                 std::uint8_t* __restrict cr) {
    for (int i = 0; i < width; ++i) {
        const auto pixel = load<std::uint32_t>(rgba + 4 * i);
        const int r = pixel & 0xff, g = pixel >> 8 & 0xff, b = pixel >> 16 & 0xff;
        cb[i] = sample<std::uint8_t, 128, 0>(to_cb<1>, r, g, b);
        cr[i] = sample<std::uint8_t, 128, 0>(to_cr<1>, r, g, b);
    }
}

DOPPEL_INLINE void alpha(const std::uint8_t* __restrict rgba, int width, std::uint8_t* __restrict alpha) {
    for (int i = 0; i < width; ++i) alpha[i] = rgba[4 * i + 3];
}

DOPPEL_INLINE void colors(const std::uint8_t* __restrict rgba, int width, std::uint8_t* __restrict rgb) {
    // writing four bytes a pixel, the last overwritten by the next pixel, is faster than writing three
    for (int i = 0; i < width - 1; ++i) std::memcpy(rgb + 3 * i, rgba + 4 * i, 4);
    std::memcpy(rgb + 3 * (width - 1), rgba + 4 * (width - 1), 3);
}

/// Sample = std::uint8_t for 8 bits, std::uint16_t for 10 bits.
template <class Sample>
DOPPEL_INLINE void convert_420(const Picture& picture, const Rect& area, const Target& to) {
    const int width = area.right - area.left;
    for (int i = 0; i < area.bottom - area.top; i += 2) {
        const std::uint8_t* upper = picture.at(area.left, area.top + i);
        const std::uint8_t* lower = picture.at(area.left, area.top + i + 1);
        luma(upper, width, to.row<Sample>(0, i));
        luma(lower, width, to.row<Sample>(0, i + 1));
        chroma_of_four(upper, lower, width, to.row<Sample>(1, i / 2), to.row<Sample>(2, i / 2));
    }
}

}  // namespace

// libav's functions for whole pictures refuse those above 2^31 / 8 pixels
PlaneArea plane_area(AVPixelFormat format, int plane, const Rect& area) {
    const int shift = plane == 1 || plane == 2 ? av_pix_fmt_desc_get(format)->log2_chroma_h : 0;
    const auto bytes = [&](int width) { return av_image_get_linesize(format, width, plane); };
    return {bytes(area.left), bytes(area.right - area.left), area.top >> shift, (area.bottom - area.top) >> shift};
}

std::size_t byte_count(AVPixelFormat format, const Rect& area) {
    std::size_t count = 0;
    for (int k = 0; k < av_pix_fmt_count_planes(format); ++k) {
        const auto plane = plane_area(format, k, area);
        count += static_cast<std::size_t>(plane.row_bytes) * static_cast<std::size_t>(plane.rows);
    }
    return count;
}

std::size_t byte_count(AVPixelFormat format, const std::vector<Rect>& areas) {
    std::size_t count = 0;
    for (const Rect& area : areas) count += byte_count(format, area);
    return count;
}

Rect aligned(AVPixelFormat format, const Rect& area, Size picture) {
    const Rect inside = intersection(area, {0, 0, picture.width, picture.height});
    if (av_pix_fmt_desc_get(format)->log2_chroma_w == 0 || inside.empty()) return inside;
    return {inside.left & ~1, inside.top & ~1, (inside.right + 1) & ~1, (inside.bottom + 1) & ~1};
}

DOPPEL_WIDEST_SIMD
void convert(const Picture& picture, const Rect& area, AVPixelFormat format, std::uint8_t* to) {
    const int width = area.right - area.left;
    Target out;
    for (std::size_t k = 0; k < out.plane.size(); ++k) {
        const auto plane = plane_area(format, static_cast<int>(k), area);
        out.plane[k] = to;
        out.stride[k] = plane.row_bytes;
        to += std::ptrdiff_t{plane.row_bytes} * plane.rows;
    }
    if (format == AV_PIX_FMT_YUV420P10LE) convert_420<std::uint16_t>(picture, area, out);
    if (format == AV_PIX_FMT_YUV420P || format == AV_PIX_FMT_YUVA420P) convert_420<std::uint8_t>(picture, area, out);
    for (int i = 0; i < area.bottom - area.top; ++i) {
        const std::uint8_t* rgba = picture.at(area.left, area.top + i);
        if (format == AV_PIX_FMT_YUVA420P) alpha(rgba, width, out.row(3, i));
        if (format == AV_PIX_FMT_RGB24) colors(rgba, width, out.row(0, i));
        if (format == AV_PIX_FMT_RGBA) std::memcpy(out.row(0, i), rgba, std::size_t{4} * width);
        if (format != AV_PIX_FMT_YUV444P) continue;
        luma(rgba, width, out.row(0, i));
        chroma_of_one(rgba, width, out.row(1, i), out.row(2, i));
    }
}

void convert(const Picture& picture, const std::vector<Rect>& changed, AVPixelFormat format, SampledAreas& to) {
    to.areas.clear();
    for (const Rect& area : changed)
        if (const Rect grown = aligned(format, area, picture.size); !grown.empty()) to.areas.push_back(grown);
    std::uint8_t* next = to.bytes.make_room(byte_count(format, to.areas));
    for (const Rect& area : to.areas) {
        convert(picture, area, format, next);
        next += byte_count(format, area);
    }
}

}  // namespace doppel

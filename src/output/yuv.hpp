#pragma once

#include <cstdint>

namespace doppel {

// Rows of RGBA pixels to rows of samples, BT.709 in limited range: Y and chroma of 8 bits, or of 10 in two bytes.
// Chroma is that of each pixel, or of 2×2 pixels in two rows (then `width` is even). RGB are the pixels without alpha.

void luma_row(const std::uint8_t* rgba, int width, std::uint8_t* y);
void luma_row(const std::uint8_t* rgba, int width, std::uint16_t* y);
void chroma_row(const std::uint8_t* rgba, int width, std::uint8_t* cb, std::uint8_t* cr);
void chroma_row(const std::uint8_t* upper, const std::uint8_t* lower, int width, std::uint8_t* cb, std::uint8_t* cr);
void chroma_row(const std::uint8_t* upper, const std::uint8_t* lower, int width, std::uint16_t* cb, std::uint16_t* cr);
void alpha_row(const std::uint8_t* rgba, int width, std::uint8_t* alpha);
void rgb_row(const std::uint8_t* rgba, int width, std::uint8_t* rgb);

}  // namespace doppel

#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"

#include <cstdint>
#include <vector>

namespace doppel {

/// How much of each pixel a glyph covers, 0…255. Rows from the top down.
struct Coverage {
    int left = 0, top = 0;  // of the first pixel, px from the pen's whole pixel on the baseline
    Size size;
    std::vector<std::uint8_t> values;
};

/// The glyphs of the one font there is, DejaVu Sans, known by their number in it. Sizes are px an em.
namespace glyphs {

/// The number of a character's glyph; 0, a hollow box, for what the font lacks.
int number_of(char32_t character);

/// How far the pen moves past a glyph, px.
float advance(int glyph, float size, Weight weight);

/// A glyph drawn with the pen `shift` px, 0…1, right of a pixel's left edge. The font has one weight: bold moves the
/// outline outward.
Coverage rasterised(int glyph, float size, Weight weight, float shift);

}  // namespace glyphs
}  // namespace doppel

#pragma once

#include "picture/display_list.hpp"
#include "picture/glyph_atlas.hpp"

#include <array>
#include <cstdint>

namespace doppel {

/// Everything is drawn as rectangles, maybe turned, each with a few numbers for the fragment shader of its kind.
struct Quad {
    Point center;                        // px
    Point axis{1, 0};                    // unit vector along its first side
    Point half;                          // half its sides, px
    std::array<float, 4> shape{};        // see the shader
    std::array<std::uint8_t, 4> tint{};  // sRGB and opacity
    const Picture* image = nullptr;      // one of Sketch::images
    friend bool operator==(const Quad&, const Quad&);
};

/// The fragment shaders. A stroke takes two: `mask` gathers how opaque it is, `cover` lays its colour through the mask.
enum class Kind { shape, glyph, mask, cover, image };

/// A display list made ready to draw: rectangles, part by part from back to front.
struct Sketch {
    struct Part {
        Kind kind;
        std::size_t begin, end;  // in quads and in bounds
    };
    std::vector<Part> parts;
    std::vector<Quad> quads;
    std::vector<Rect> bounds;                            // the pixels that each quad touches, within the picture
    std::vector<std::shared_ptr<const Picture>> images;  // kept, so that none can take the place of another in memory
};

/// An item without ink adds a part without quads, or none.
Sketch sketch(const DisplayList& list, Size size, GlyphAtlas& atlas);

}  // namespace doppel

#pragma once

#include "render/display_list.hpp"
#include "render/font.hpp"

#include <array>
#include <cstdint>

namespace doppel {

/// What the fragment shader of a kind must know to draw one thing.
struct Primitive {
    Point origin;                        // of the thing's own axes, px
    Point axis{1, 0};                    // unit vector along the first of them
    Point half;                          // how far it reaches along them to either side, px; 0 where it does not turn
    std::array<float, 4> shape{};        // see the shader
    std::array<float, 4> params{};       // likewise
    std::array<float, 2> parabola{};     // likewise
    std::array<std::uint8_t, 4> tint{};  // sRGB and opacity
    const Picture* image = nullptr;      // one of RenderList::images
    friend bool operator==(const Primitive&, const Primitive&);
};

/// The fragment shaders. What is of kind `mask` is drawn twice: first it gathers how opaque the stroke is, then the
/// shader `cover` lays the stroke's colour through the mask.
enum class Kind { shape, glyph, mask, image };

/// A display list made ready to draw: rectangles of whole pixels, part by part from back to front.
struct RenderList {
    struct Part {
        Kind kind;
        std::size_t begin = 0, end = 0;  // in primitives and in bounds
        Rect bounds{};                   // of them all
    };
    std::vector<Part> parts;
    std::vector<Primitive> primitives;
    std::vector<Rect> bounds;                            // the pixels that each primitive touches, within the picture
    std::vector<std::shared_ptr<const Picture>> images;  // kept, so that none can take the place of another in memory
};

/// Makes `made` the render list of `list`; what it held goes, but for its memory. An item without ink adds a part
/// without primitives, or none.
void make_render_list(const DisplayList& list, Size size, GlyphAtlas& atlas, RenderList& made);

}  // namespace doppel

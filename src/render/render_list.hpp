#pragma once

#include "render/display_list.hpp"
#include "render/glyph_atlas.hpp"

#include <array>
#include <cstdint>

namespace doppel {

/// The input of a fragment shader for one shape.
struct Primitive {
    Point origin;                        // centre of its own axes, px
    Point axis{1, 0};                    // unit vector along the first axis
    Point half;                          // extent to either side along both axes, px; 0 for glyphs
    std::array<float, 4> shape{};        // see the shader
    std::array<float, 4> params{};       // likewise
    std::array<float, 2> parabola{};     // likewise
    std::array<std::uint8_t, 4> tint{};  // sRGB and opacity
    Rect bounds{};                       // the pixels that it touches, inside the picture
    friend bool operator==(const Primitive&, const Primitive&) = default;
};

/// The fragment shaders. A `mask` takes a second pass, in which the shader `cover` blends the stroke's colour by the
/// mask.
enum class Kind { shape, glyph, mask };

/// A display list converted to primitives with bounds in whole pixels; its parts are in order from back to front.
struct RenderList {
    struct Part {
        Kind kind;
        std::size_t begin = 0, end = 0;  // range of primitives
        Rect bounds{};                   // union of their bounds
    };
    std::vector<Part> parts;
    std::vector<Primitive> primitives;
};

/// Converts `list` into `made`, whose memory is reused. An invisible item adds an empty part, or none.
void make_render_list(const DisplayList& list, Size size, GlyphAtlas& atlas, RenderList& made);

/// Where the pictures of two render lists may differ, as a few disjoint rectangles. Outside, both have the same
/// primitives in the same order.
std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after);

}  // namespace doppel

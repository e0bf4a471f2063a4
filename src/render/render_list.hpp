#pragma once

#include "render/display_list.hpp"
#include "render/glyph_atlas.hpp"

#include <array>
#include <cstdint>

namespace doppel {

/// The input of a fragment shader for one shape.
struct Primitive {
    Point origin;                        // of its own axes, px
    Point axis{1, 0};                    // unit vector along the first of them
    Point half;                          // how far it reaches along them to either side, px; 0 where it does not turn
    std::array<float, 4> shape{};        // see the shader
    std::array<float, 4> params{};       // likewise
    std::array<float, 2> parabola{};     // likewise
    std::array<std::uint8_t, 4> tint{};  // sRGB and opacity
    friend bool operator==(const Primitive&, const Primitive&);
};

/// The fragment shaders. `mask` takes a second pass: the shader `cover` blends the stroke's colour through the mask.
enum class Kind { shape, glyph, mask };

/// A display list as primitives with bounds in whole pixels, part by part from back to front.
struct RenderList {
    struct Part {
        Kind kind;
        std::size_t begin = 0, end = 0;  // in primitives and in bounds
        Rect bounds{};                   // of them all
    };
    std::vector<Part> parts;
    std::vector<Primitive> primitives;
    std::vector<Rect> bounds;  // the pixels that each primitive touches, within the picture
};

/// `made` ← the render list of `list`, in the memory it has. An invisible item adds an empty part, or none.
void make_render_list(const DisplayList& list, Size size, GlyphAtlas& atlas, RenderList& made);

/// Few disjoint rectangles that cover all of `rects`; those are joined that are cheaper to draw as one.
std::vector<Rect> merged(std::vector<Rect> rects);

/// Where the pictures of two render lists may differ, as few disjoint rectangles. Elsewhere both have the same
/// primitives in the same order.
std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after);

}  // namespace doppel

#pragma once

#include "picture/display_list.hpp"
#include "picture/glyph_atlas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace doppel {

/// What the fragment shader of a kind must know to draw one thing.
struct Mark {
    Point origin;                        // of the thing's own axes, px
    Point axis{1, 0};                    // unit vector along the first of them
    Point half;                          // how far it reaches along them to either side, px; 0 where it does not turn
    std::array<float, 4> shape{};        // see the shader
    std::array<float, 4> more{};         // likewise
    std::array<float, 2> bow{};          // likewise
    std::array<std::uint8_t, 4> tint{};  // sRGB and opacity
    const Picture* image = nullptr;      // one of Sketch::images
    friend bool operator==(const Mark&, const Mark&);
};

/// The fragment shaders. What is of kind `mask` is drawn twice: first it gathers how opaque the stroke is, then the
/// shader `cover` lays the stroke's colour through the mask.
enum class Kind { shape, glyph, mask, image };

/// A display list made ready to draw: rectangles of whole pixels, part by part from back to front.
struct Sketch {
    struct Part {
        Kind kind;
        std::size_t begin = 0, end = 0;  // in marks and in bounds
        Rect bounds{};                   // of them all
    };
    std::vector<Part> parts;
    std::vector<Mark> marks;
    std::vector<Rect> bounds;                            // the pixels that each mark touches, within the picture
    std::vector<std::shared_ptr<const Picture>> images;  // kept, so that none can take the place of another in memory
};

/// Calls visit(part) for rectangles, none overlapping, that together hold what the mark touches of its bounds: one, or
/// bands if it is long and slants.
template <class Visit>
void for_each_band(const Mark& mark, const Rect& bounds, const Visit& visit) {
    const float across = std::abs(mark.axis.x), down = std::abs(mark.axis.y);
    const int thick = 16 + 4 * static_cast<int>(std::min(mark.half.y, 1000.f));
    const int shorter = std::min(bounds.right - bounds.left, bounds.bottom - bounds.top);
    if (shorter < 3 * thick || !(mark.half.x > 2 * mark.half.y) || std::min(across, down) < 0.05f) return visit(bounds);
    // cut along the axis that it follows more; a hair of room for rounding
    const bool steep = down > across;
    const float slope = steep ? mark.axis.x / mark.axis.y : mark.axis.y / mark.axis.x;
    const float margin = mark.half.y / std::max(across, down) + 0.05f;
    const float middle = steep ? mark.origin.x : mark.origin.y, start = steep ? mark.origin.y : mark.origin.x;
    const int end = steep ? bounds.bottom : bounds.right;
    for (int a = steep ? bounds.top : bounds.left; a < end; a += thick) {
        const int b = std::min(a + thick, end);
        const float at_a = middle + slope * (static_cast<float>(a) - start);
        const float at_b = middle + slope * (static_cast<float>(b) - start);
        const int low = static_cast<int>(std::floor(std::min(at_a, at_b) - margin));
        const int high = static_cast<int>(std::ceil(std::max(at_a, at_b) + margin));
        const Rect band = common(bounds, steep ? Rect{low, a, high, b} : Rect{a, low, b, high});
        if (!band.empty()) visit(band);
    }
}

/// Makes `made` the sketch of `list`; what it held goes, but for its memory. An item without ink adds a part without
/// marks, or none.
void sketch(const DisplayList& list, Size size, GlyphAtlas& atlas, Sketch& made);

}  // namespace doppel

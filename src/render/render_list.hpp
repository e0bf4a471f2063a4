#pragma once

#include "render/display_list.hpp"
#include "render/typeface.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace doppel {

/// One image with the coverage of all glyphs drawn so far. It fills in shelves and grows downward; slots never move.
class GlyphAtlas {
public:
    /// Subpixel positions of the pen.
    static constexpr int subpixels = 4;
    static constexpr int width = 1024;  // px

    struct Slot {
        int left = 0, top = 0;  // of the first pixel, px from the whole pixel of the pen on the baseline
        Size size;              // empty for a space
        int x = 0, y = 0;       // in the atlas
    };

    /// `max_height`, px: OpenGL's limit for textures. `typeface`: the fonts of all text.
    GlyphAtlas(int max_height, Typeface typeface) : typeface_(std::move(typeface)), max_height_(max_height) {}

    const Typeface& typeface() const { return typeface_; }

    /// The slot of a glyph, which is rasterised if it is new. Throws Error if the atlas is full.
    const Slot& slot(const TextLine::Glyph& glyph, float size, int subpixel);

    const std::vector<std::uint8_t>& values() const { return values_; }
    int height() const { return static_cast<int>(values_.size()) / width; }
    std::size_t count() const { return slots_.size(); }

private:
    using Key = std::tuple<const Font*, int, float, int>;
    Typeface typeface_;
    std::map<Key, Slot> slots_;
    std::vector<std::uint8_t> values_;
    int max_height_;
    int pen_ = 0, shelf_ = 0, shelf_height_ = 0;  // px
};

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

/// The fragment shaders. A `mask` takes a second pass, by the shader `cover`.
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

/// Where the pictures of two render lists may differ, as a few disjoint rectangles.
std::vector<Rect> dirty_regions(const RenderList& before, const RenderList& after);

}  // namespace doppel

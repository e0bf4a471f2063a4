#pragma once

#include "render/typeface.hpp"

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
    const Slot& slot(const TextLine::Glyph& glyph, float size, Weight weight, int subpixel);

    const std::vector<std::uint8_t>& values() const { return values_; }
    int height() const { return static_cast<int>(values_.size()) / width; }
    std::size_t count() const { return slots_.size(); }

private:
    using Key = std::tuple<const Font*, int, float, Weight, int>;
    Typeface typeface_;
    std::map<Key, Slot> slots_;
    std::vector<std::uint8_t> values_;
    int max_height_;
    int pen_ = 0, shelf_ = 0, shelf_height_ = 0;  // px
};

}  // namespace doppel

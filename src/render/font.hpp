#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"

#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

namespace doppel {

/// How far the pen moves along `text`, px; the same arithmetic that places the glyphs when it is drawn.
float text_width(std::string_view text, float size, Weight weight = Weight::regular);

/// `size`, or as much less as makes `text` no wider than `width` px.
float fitting_size(std::string_view text, float size, Weight weight, float width);

/// A line of text as the pen writes it.
struct TextLine {
    struct Glyph {
        int number = 0;  // in the font
        float pen = 0;   // px right of the start of the line
    };
    std::vector<Glyph> glyphs;
    float width = 0;  // px
};

/// Text is UTF-8; each byte that is not becomes U+FFFD.
TextLine lay_out(std::string_view text, float size, Weight weight);

/// The first character of `text` that would be drawn as a hollow box, or not at all: one that the font lacks, or a
/// control character. Empty where there is none.
std::string_view lacking_character(std::string_view text);

/// Glyphs drawn so far, side by side in one image of coverage. It fills shelf by shelf and grows downward, so what has
/// a place keeps it.
class GlyphAtlas {
public:
    /// The pen stands on one of `stops` places within a pixel.
    static constexpr int stops = 4;
    static constexpr int width = 1024;  // px

    struct Slot {
        int left = 0, top = 0;  // of the first pixel, px from the pen's whole pixel on the baseline
        Size size;              // empty for a space
        int x = 0, y = 0;       // in the atlas
    };

    /// `max_height`, px, is what the machine can take as a texture.
    explicit GlyphAtlas(int max_height) : max_height_(max_height) {}

    /// Draws the glyph if it is new. Throws Error where it finds no room.
    const Slot& slot(int glyph, float size, Weight weight, int stop);

    const std::vector<std::uint8_t>& values() const { return values_; }
    int height() const { return static_cast<int>(values_.size()) / width; }
    std::size_t count() const { return slots_.size(); }

private:
    using Key = std::tuple<int, float, Weight, int>;
    std::map<Key, Slot> slots_;
    std::vector<std::uint8_t> values_;
    int max_height_;
    int pen_ = 0, shelf_ = 0, shelf_height_ = 0;  // px
};

}  // namespace doppel

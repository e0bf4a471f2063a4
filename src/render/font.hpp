#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"

#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

namespace doppel {

/// The advance width of `text`, px, exactly as it is drawn.
float text_width(std::string_view text, float size, Weight weight = Weight::regular);

/// `size`, or as much less as makes `text` no wider than `width` px.
float fitting_size(std::string_view text, float size, Weight weight, float width);

/// A line of positioned glyphs.
struct TextLine {
    struct Glyph {
        int number = 0;        // in the font
        float pen = 0;         // px right of the start of the line
        std::size_t byte = 0;  // where its character begins in the text
    };
    std::vector<Glyph> glyphs;
    float width = 0;  // px
};

/// The built-in font has one weight. Bold: how much wider the pen is, which draws on either side of the outline, and
/// how much further the next letter is; em.
inline constexpr float bold_pen = 0.0345f, bold_spacing = 0.0300f;

/// The built-in font: a TrueType file.
std::string_view font_file();

/// Text is UTF-8; each byte that is not becomes U+FFFD.
TextLine lay_out(std::string_view text, float size, Weight weight);

/// Where the pen begins, px.
Point start_of(const Label& label, const TextLine& line);

/// The first character of `text` that the font lacks, or that is a control character. Empty where there is none.
std::string_view missing_character(std::string_view text);

/// Coverage of the glyphs drawn so far, in one image. It fills shelf by shelf and grows downward: slots never move.
class GlyphAtlas {
public:
    /// Subpixel positions of the pen.
    static constexpr int subpixels = 4;
    static constexpr int width = 1024;  // px

    struct Slot {
        int left = 0, top = 0;  // of the first pixel, px from the pen's whole pixel on the baseline
        Size size;              // empty for a space
        int x = 0, y = 0;       // in the atlas
    };

    /// `max_height`, px: OpenGL's limit for textures.
    explicit GlyphAtlas(int max_height) : max_height_(max_height) {}

    /// Rasterises the glyph if it is new. Throws Error where the atlas is full.
    const Slot& slot(int glyph, float size, Weight weight, int subpixel);

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

#include "render/font.hpp"

#include "base/error.hpp"
#include "base/text.hpp"
#include "embedded/render.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

namespace doppel {
namespace {

/// How much of each pixel a glyph covers, 0…255. Rows from the top down.
struct Coverage {
    int left = 0, top = 0;  // of the first pixel, px from the pen's whole pixel on the baseline
    Size size;
    std::vector<std::uint8_t> values;
};

// how far bold moves the outline to either side, em: vertical stems grow more than horizontal bars
constexpr float bold_across = 0.0215f;
constexpr float bold_along = 0.0130f;

const stbtt_fontinfo& font() {
    static const stbtt_fontinfo loaded = [] {
        stbtt_fontinfo info;
        if (stbtt_InitFont(&info, reinterpret_cast<const unsigned char*>(font_file().data()), 0) != 0) return info;
        throw io_failed("the built-in font cannot be read");
    }();
    return loaded;
}

float em_to_pixels(float size) {
    return stbtt_ScaleForMappingEmToPixels(&font(), size);
}

/// A point of an outline, on the curve or off it.
struct ControlPoint {
    short *x, *y;
    Point at, moved;
};

/// Moves one closed contour to its left, which is outward in TrueType, where ink lies on the right of the pen.
void embolden(std::span<ControlPoint> contour, Point strength) {
    const std::size_t n = contour.size();
    // the unit vector from a point to the next one elsewhere, walking in steps of +1 or −1
    const auto direction = [&](std::size_t from, std::size_t step) {
        for (std::size_t k = 1; k < n; ++k) {
            const Point a = contour[from].at, b = contour[(from + k * step) % n].at;
            const float length = std::hypot(b.x - a.x, b.y - a.y);
            if (length > 0) return Point{(b.x - a.x) / length, (b.y - a.y) / length};
        }
        return Point{};
    };
    for (std::size_t i = 0; i < n; ++i) {
        const Point out = direction(i, 1), back = direction(i, n - 1);
        // both sides stay parallel: the point slides along the bisector, but not far at a sharp tip
        const Point in{-back.x, -back.y};
        const float sharpness = std::max(1 + in.x * out.x + in.y * out.y, 0.35f);
        contour[i].moved = {contour[i].at.x - strength.x * (in.y + out.y) / sharpness,
                            contour[i].at.y + strength.y * (in.x + out.x) / sharpness};
    }
    for (const ControlPoint& point : contour) {
        *point.x = static_cast<short>(std::lround(point.moved.x));
        *point.y = static_cast<short>(std::lround(point.moved.y));
    }
}

void embolden_all(std::span<stbtt_vertex> outline, Point strength) {
    std::vector<ControlPoint> contour;
    const auto add = [&](short& x, short& y) {
        contour.push_back({&x, &y, {static_cast<float>(x), static_cast<float>(y)}, {}});
    };
    for (stbtt_vertex& v : outline) {
        if (v.type == STBTT_vmove) {
            embolden(contour, strength);
            contour.clear();
        }
        if (v.type == STBTT_vcurve) add(v.cx, v.cy);
        add(v.x, v.y);
    }
    embolden(contour, strength);
}

/// How much of the pixel i…i + 1 lies between `from` and `to`, 0…1.
float overlap(int i, float from, float to) {
    const auto pixel = static_cast<float>(i);
    return std::max(0.0f, std::min(pixel + 1, to) - std::max(pixel, from));
}

/// The hollow box for a missing glyph; the font's own is empty.
Coverage missing_box(float size, Weight weight, float shift) {
    const float pen = size * (weight == Weight::bold ? 0.09f : 0.06f);
    const float left = shift + 0.1f * size, right = shift + 0.5f * size, height = 0.7f * size;
    Coverage coverage;
    coverage.left = static_cast<int>(std::floor(left));
    coverage.top = static_cast<int>(std::floor(-height));
    coverage.size = {static_cast<int>(std::ceil(right)) - coverage.left, -coverage.top};
    for (int y = coverage.top; y < 0; ++y) {
        for (int x = coverage.left; x < coverage.left + coverage.size.width; ++x) {
            const float outer = overlap(x, left, right) * overlap(y, -height, 0);
            const float inner = overlap(x, left + pen, right - pen) * overlap(y, pen - height, -pen);
            coverage.values.push_back(byte_of(outer - inner));
        }
    }
    return coverage;
}

/// The number of a character's glyph; 0, a hollow box, for what the font lacks.
int number_of(char32_t character) {
    return stbtt_FindGlyphIndex(&font(), static_cast<int>(character));
}

/// How far the pen moves past a glyph, px.
float advance(int glyph, float size, Weight weight) {
    int units = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&font(), glyph, &units, &bearing);
    // letters move apart by less than they grow: heavier text is set tighter
    const float extra = weight == Weight::bold && units > 0 ? bold_spacing * size : 0;
    return static_cast<float>(units) * em_to_pixels(size) + extra;
}

/// A glyph drawn with the pen `shift` px, 0…1, right of a pixel's left edge. The font has one weight: bold moves the
/// outline outward.
Coverage rasterised(int glyph, float size, Weight weight, float shift) {
    if (glyph == 0) return missing_box(size, weight, shift);
    stbtt_vertex* vertices = nullptr;
    const int count = stbtt_GetGlyphShape(&font(), glyph, &vertices);
    const auto give_back = [](stbtt_vertex* v) { stbtt_FreeShape(&font(), v); };
    const std::unique_ptr<stbtt_vertex, decltype(give_back)> owner(vertices, give_back);
    if (count == 0) return {};
    const std::span outline(vertices, static_cast<std::size_t>(count));

    // the outline at its final weight; the bold one sits in the middle of its wider advance
    const float scale = em_to_pixels(size);
    if (weight == Weight::bold) {
        const float units_per_em = size / scale;
        embolden_all(outline, {bold_across * units_per_em, bold_along * units_per_em});
        shift += bold_spacing / 2 * size;
    }
    Area extent{1e9f, 1e9f, -1e9f, -1e9f};
    const auto include = [&](float x, float y) {
        extent = {std::min(extent.left, x), std::min(extent.top, y), std::max(extent.right, x),
                  std::max(extent.bottom, y)};
    };
    for (const stbtt_vertex& v : outline) {
        include(v.x * scale + shift, -v.y * scale);
        if (v.type == STBTT_vcurve) include(v.cx * scale + shift, -v.cy * scale);
    }

    Coverage coverage;
    coverage.left = static_cast<int>(std::floor(extent.left));
    coverage.top = static_cast<int>(std::floor(extent.top));
    coverage.size = {static_cast<int>(std::ceil(extent.right)) - coverage.left,
                     static_cast<int>(std::ceil(extent.bottom)) - coverage.top};
    if (coverage.size.width <= 0 || coverage.size.height <= 0) return {};
    coverage.values.resize(static_cast<std::size_t>(coverage.size.width) * coverage.size.height);
    stbtt__bitmap target{coverage.size.width, coverage.size.height, coverage.size.width, coverage.values.data()};
    const float flatness = 0.05f;  // px
    stbtt_Rasterize(&target, flatness, vertices, count, scale, scale, shift, 0, coverage.left, coverage.top, 1,
                    nullptr);
    return coverage;
}

}  // namespace

TextLine lay_out(std::string_view text, float size, Weight weight) {
    TextLine line;
    line.glyphs.reserve(text.size());
    const std::size_t bytes = text.size();
    while (!text.empty()) {
        const std::size_t byte = bytes - text.size();
        const int number = number_of(next_character(text));
        line.glyphs.push_back({number, line.width, byte});
        line.width += advance(number, size, weight);
    }
    return line;
}

std::string_view font_file() {
    const auto files = render_files();
    const auto found = std::ranges::find(files, "DejaVuSans.ttf", &EmbeddedFile::name);
    if (found == files.end()) throw io_failed("the font DejaVuSans.ttf was not built in");
    return found->contents;
}

Point start_of(const Label& label, const TextLine& line) {
    const float before = label.align == Align::left ? 0 : label.align == Align::center ? 0.5f : 1;
    return {label.anchor.x - before * line.width, std::round(label.anchor.y)};
}

float fitting_size(std::string_view text, float size, Weight weight, float width) {
    const float wanted = text_width(text, size, weight);
    return wanted > width ? size * std::max(width, 0.0f) / wanted : size;
}

float text_width(std::string_view text, float size, Weight weight) {
    return lay_out(text, size, weight).width;
}

std::string_view missing_character(std::string_view text) {
    while (!text.empty()) {
        const auto from = text;
        const auto character = next_character(text);
        if (is_control(character) || number_of(character) == 0) return from.substr(0, from.size() - text.size());
    }
    return {};
}

const GlyphAtlas::Slot& GlyphAtlas::slot(int glyph, float size, Weight weight, int subpixel) {
    const Key key{glyph, size, weight, subpixel};
    if (const auto found = slots_.find(key); found != slots_.end()) return found->second;

    const Coverage drawn = rasterised(glyph, size, weight, static_cast<float>(subpixel) / subpixels);
    if (pen_ + drawn.size.width > width) {
        pen_ = 0;
        shelf_ += shelf_height_;
        shelf_height_ = 0;
    }
    shelf_height_ = std::max(shelf_height_, drawn.size.height);
    if (drawn.size.width > width || shelf_ + shelf_height_ > max_height_) {
        throw io_failed("no room for a glyph of {} × {} px: the text is too large or has too many sizes",
                        drawn.size.width, drawn.size.height);
    }
    if (shelf_ + shelf_height_ > height()) {
        const int enough = std::min(std::max(2 * height(), shelf_ + shelf_height_ + 255), max_height_);
        values_.resize(static_cast<std::size_t>(width) * enough);
    }

    const Slot slot{drawn.left, drawn.top, drawn.size, pen_, shelf_};
    for (int row = 0; row < drawn.size.height; ++row) {
        std::copy_n(&drawn.values[static_cast<std::size_t>(row) * drawn.size.width], drawn.size.width,
                    &values_[static_cast<std::size_t>(shelf_ + row) * width + pen_]);
    }
    pen_ += drawn.size.width;
    return slots_.emplace(key, slot).first->second;
}

}  // namespace doppel

#include "render/font.hpp"

#include "base/error.hpp"
#include "embedded/render.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <span>
#include <system_error>
#include <utility>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

namespace doppel {
namespace {

// how far bold moves the outline to either side, em: vertical stems grow more than horizontal bars
constexpr float bold_across = 0.0215f;
constexpr float bold_along = 0.0130f;

/// A point of an outline, on the curve or off it.
struct ControlPoint {
    short *x, *y;
    Point at, moved;
};

/// Moves one closed contour to its left, which is outward where ink lies on the right of the pen.
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
        if (v.type == STBTT_vcurve || v.type == STBTT_vcubic) add(v.cx, v.cy);
        if (v.type == STBTT_vcubic) add(v.cx1, v.cy1);
        add(v.x, v.y);
    }
    embolden(contour, strength);
}

/// The rectangle that holds an outline, px right of the pen's pixel and below the baseline.
Area extent_of(std::span<const stbtt_vertex> outline, float scale, float shift) {
    Area extent{1e9f, 1e9f, -1e9f, -1e9f};
    const auto include = [&](float x, float y) {
        extent = {std::min(extent.left, x), std::min(extent.top, y), std::max(extent.right, x),
                  std::max(extent.bottom, y)};
    };
    for (const stbtt_vertex& v : outline) {
        include(v.x * scale + shift, -v.y * scale);
        if (v.type == STBTT_vcurve || v.type == STBTT_vcubic) include(v.cx * scale + shift, -v.cy * scale);
        if (v.type == STBTT_vcubic) include(v.cx1 * scale + shift, -v.cy1 * scale);
    }
    return extent;
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

unsigned number_at(std::string_view bytes, std::size_t at, int count) {
    unsigned value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
    return value;
}

/// Whether all tables of the font that begins at `start` lie in the file: stb_truetype reads them unchecked.
bool is_whole(std::string_view bytes, std::size_t start) {
    constexpr std::size_t header = 12, entry = 16;
    if (start + header > bytes.size()) return false;
    const std::size_t tables = number_at(bytes, start + 4, 2);
    if (start + header + tables * entry > bytes.size()) return false;
    for (std::size_t i = 0; i < tables; ++i) {
        const std::size_t at = start + header + i * entry;
        if (std::size_t{number_at(bytes, at + 8, 4)} + number_at(bytes, at + 12, 4) > bytes.size()) return false;
    }
    return true;
}

std::string contents_of(const std::filesystem::path& path) {
    constexpr std::uintmax_t most_bytes = std::uintmax_t{256} << 20;
    std::error_code fault;
    const auto status = std::filesystem::status(path, fault);
    if (!std::filesystem::exists(status)) throw bad_input("there is no such file");
    if (!std::filesystem::is_regular_file(status)) throw bad_input("is not a file");
    if (std::filesystem::file_size(path, fault) > most_bytes) throw bad_input("has more than {} MB", most_bytes >> 20);
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (!file) throw io_failed("cannot be read: {}", std::generic_category().message(errno));
    return bytes;
}

}  // namespace

struct Font::Tables {
    stbtt_fontinfo info{};
    bool is_postscript = false;  // its outlines have their ink on the left of the pen
    bool is_complete = false;    // has an outline for all that it has a number for
};

Font::Font(std::filesystem::path file, std::string owned, std::string_view bytes, int index)
    : file_(std::move(file)),
      owned_(std::move(owned)),
      bytes_(owned_.empty() ? bytes : owned_),
      index_(index),
      tables_(std::make_unique<Tables>()) {
    bytes = bytes_;
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    constexpr std::size_t least = 16;  // up to the first font's place in a collection
    const int start = bytes.size() < least ? -1 : stbtt_GetFontOffsetForIndex(data, index);
    if (start < 0) throw bad_input("is no TrueType or OpenType font");
    if (!is_whole(bytes, static_cast<std::size_t>(start))) throw bad_input("is cut short");
    if (stbtt_InitFont(&tables_->info, data, start) == 0) throw bad_input("is a font without outlines");
    tables_->is_postscript = tables_->info.cff.size > 0;
    tables_->is_complete = owned_.empty();
}

Font::~Font() = default;

const Font& Font::built_in() {
    static const Font font = [] {
        for (const EmbeddedFile& file : render_files())
            if (file.name == "DejaVuSans.ttf") return Font({}, {}, file.contents, 0);
        throw io_failed("there is no built-in font DejaVuSans.ttf");
    }();
    return font;
}

std::shared_ptr<const Font> Font::from_file(const std::filesystem::path& path, int index) {
    return std::shared_ptr<const Font>(new Font(path, contents_of(path), {}, index));
}

int Font::number_of(char32_t character) const {
    const int number = stbtt_FindGlyphIndex(&tables_->info, static_cast<int>(character));
    if (number == 0 || tables_->is_complete) return number;
    const bool is_space = character == U' ' || character == U'\u00a0' || character == U'\u3000' ||
                          (character >= U'\u2000' && character <= U'\u200a') || character == U'\u202f';
    return !is_space && stbtt_IsGlyphEmpty(&tables_->info, number) != 0 ? 0 : number;
}

float Font::advance(int glyph, float size, Weight weight) const {
    int units = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&tables_->info, glyph, &units, &bearing);
    // letters move apart by less than they grow: heavier text is set tighter
    const float extra = weight == Weight::bold && units > 0 ? bold_spacing * size : 0;
    return static_cast<float>(units) * stbtt_ScaleForMappingEmToPixels(&tables_->info, size) + extra;
}

Coverage Font::rasterised(int glyph, float size, Weight weight, float shift) const {
    if (glyph == 0) return missing_box(size, weight, shift);
    const stbtt_fontinfo& font = tables_->info;
    stbtt_vertex* vertices = nullptr;
    const int count = stbtt_GetGlyphShape(&font, glyph, &vertices);
    const auto give_back = [&](stbtt_vertex* v) { stbtt_FreeShape(&font, v); };
    const std::unique_ptr<stbtt_vertex, decltype(give_back)> owner(vertices, give_back);
    if (count == 0) return {};
    const std::span outline(vertices, static_cast<std::size_t>(count));

    // the outline at its final weight; the bold one sits in the middle of its wider advance
    const float scale = stbtt_ScaleForMappingEmToPixels(&font, size);
    if (weight == Weight::bold) {
        const float units_per_em = (tables_->is_postscript ? -size : size) / scale;
        embolden_all(outline, {bold_across * units_per_em, bold_along * units_per_em});
        shift += bold_spacing / 2 * size;
    }
    const Area extent = extent_of(outline, scale, shift);

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

}  // namespace doppel

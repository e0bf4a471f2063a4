#include "render/font.hpp"

#include "base/error.hpp"
#include "base/read_file.hpp"
#include "embedded/render.hpp"

#include <ft2build.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>
#include FT_FREETYPE_H
#include FT_ADVANCES_H
#include FT_OUTLINE_H
#include FT_TRUETYPE_TABLES_H
#include FT_TRUETYPE_TAGS_H

// FreeType reads font files, because it checks them; stb_truetype draws the outlines, with the same pixels everywhere
#define STBTT_assert(condition) static_cast<void>(condition)
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb_truetype.h>

namespace doppel {
namespace {

/// The rectangle that contains an outline, in px right of the pen's pixel and below the baseline.
Area extent_of(const FT_Outline& outline, float scale, float shift) {
    FT_BBox units;
    FT_Outline_Get_CBox(&outline, &units);
    const auto pixels = [&](FT_Pos of) { return static_cast<float>(of) * scale; };
    return {pixels(units.xMin) + shift, -pixels(units.yMax), pixels(units.xMax) + shift, -pixels(units.yMin)};
}

constexpr float max_ems = 16;  // largest distance from the pen; a glyph that extends further is damaged

/// The outline as stb_truetype's vertices, in font units; empty if it is damaged.
std::vector<stbtt_vertex> vertices_of(FT_Outline& outline) {
    static constexpr auto add = [](void* to, unsigned char kind, const FT_Vector& at, const FT_Vector& first,
                                   const FT_Vector& second) {
        const auto units = [](FT_Pos twice) {
            using Limits = std::numeric_limits<short>;
            return static_cast<short>(std::clamp<FT_Pos>(twice >> 1, Limits::min(), Limits::max()));
        };
        static_cast<std::vector<stbtt_vertex>*>(to)->push_back(
            {units(at.x), units(at.y), units(first.x), units(first.y), units(second.x), units(second.y), kind, 0});
        return 0;
    };
    using Vector = const FT_Vector*;
    // at twice the size, the points half way between two others are integers
    const FT_Outline_Funcs steps{
        [](Vector at, void* to) { return add(to, STBTT_vmove, *at, {}, {}); },
        [](Vector at, void* to) { return add(to, STBTT_vline, *at, {}, {}); },
        [](Vector first, Vector at, void* to) { return add(to, STBTT_vcurve, *at, *first, {}); },
        [](Vector first, Vector second, Vector at, void* to) { return add(to, STBTT_vcubic, *at, *first, *second); },
        1,
        0};
    std::vector<stbtt_vertex> vertices;
    const bool is_whole = FT_Outline_Decompose(&outline, &steps, &vertices) == 0;
    return is_whole ? vertices : std::vector<stbtt_vertex>();
}

}  // namespace

/// FreeType's face. Only one thread at a time may use it.
struct Font::Tables {
    std::mutex mutex;
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    bool is_complete = false;  // every character of the font has an outline

    ~Tables() {
        FT_Done_Face(face);
        FT_Done_FreeType(library);
    }
    /// Null if the outline cannot be read.
    FT_Outline* outline_of(int glyph) const {
        constexpr int in_units = FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP;
        const bool is_read = FT_Load_Glyph(face, static_cast<FT_UInt>(glyph), in_units) == 0;
        return is_read && face->glyph->format == FT_GLYPH_FORMAT_OUTLINE ? &face->glyph->outline : nullptr;
    }
    bool has_table(FT_ULong tag) const {
        FT_ULong bytes = 0;  // returns the length
        return FT_Load_Sfnt_Table(face, tag, 0, nullptr, &bytes) == 0;
    }
    float scale(float size) const { return size / static_cast<float>(face->units_per_EM); }
};

Font::Font(std::filesystem::path file, std::string owned, std::string_view bytes, int index)
    : file_(std::move(file)),
      owned_(std::move(owned)),
      bytes_(owned_.empty() ? bytes : owned_),
      index_(index),
      tables_(std::make_unique<Tables>()) {
    auto& [mutex, library, face, is_complete] = *tables_;
    if (FT_Init_FreeType(&library) != 0) throw io_failed("FreeType cannot be started");
    const auto* data = reinterpret_cast<const FT_Byte*>(bytes_.data());
    if (FT_New_Memory_Face(library, data, static_cast<FT_Long>(bytes_.size()), index, &face) != 0 || !FT_IS_SFNT(face))
        throw bad_input("is no TrueType or OpenType font, or is damaged");
    const bool has_outlines =
        tables_->has_table(TTAG_glyf) || tables_->has_table(TTAG_CFF) || tables_->has_table(TTAG_CFF2);
    if (!has_outlines || face->units_per_EM == 0) throw bad_input("is a font without outlines");
    if (FT_Select_Charmap(face, FT_ENCODING_UNICODE) != 0) throw bad_input("is a font without letters of Unicode");
    is_complete = owned_.empty();
}

Font::~Font() = default;

const Font& Font::built_in(Weight weight) {
    static const Font regular({}, {}, embedded_file(render_files(), "DejaVuSans.ttf"), 0);
    static const Font bold({}, {}, embedded_file(render_files(), "DejaVuSans-Bold.ttf"), 0);
    return weight == Weight::bold ? bold : regular;
}

std::shared_ptr<const Font> Font::from_file(const std::filesystem::path& path, int index) {
    auto bytes = read_whole_file(path, {"a font is a TrueType or OpenType file", std::size_t{256} << 20});
    try {
        return std::shared_ptr<const Font>(new Font(path, std::move(bytes), {}, index));
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("{}: {}", path.string(), error.what()));
    }
}

int Font::number_of(char32_t character) const {
    const std::lock_guard lock(tables_->mutex);
    const int number = static_cast<int>(FT_Get_Char_Index(tables_->face, character));
    if (number == 0 || tables_->is_complete) return number;
    const bool is_space = character == U' ' || character == U'\u00a0' || character == U'\u3000' ||
                          (character >= U'\u2000' && character <= U'\u200a') || character == U'\u202f';
    if (is_space) return number;
    const auto* outline = tables_->outline_of(number);
    return outline && outline->n_points > 0 ? number : 0;
}

float Font::advance(int glyph, float size) const {
    const std::lock_guard lock(tables_->mutex);
    FT_Fixed units = 0;
    if (FT_Get_Advance(tables_->face, static_cast<FT_UInt>(glyph), FT_LOAD_NO_SCALE, &units) != 0) units = 0;
    return static_cast<float>(units) * tables_->scale(size);
}

Coverage Font::rasterised(int glyph, float size, float shift) const {
    const std::lock_guard lock(tables_->mutex);
    FT_Outline* const read = glyph > 0 ? tables_->outline_of(glyph) : nullptr;
    if (!read) return {};
    const float scale = tables_->scale(size);
    auto outline = vertices_of(*read);
    if (outline.empty()) return {};
    const Area extent = extent_of(*read, scale, shift);
    const float reach = std::max({-extent.left, -extent.top, extent.right, extent.bottom});
    if (!(reach <= max_ems * size)) return {};

    Coverage coverage;
    coverage.left = static_cast<int>(std::floor(extent.left));
    coverage.top = static_cast<int>(std::floor(extent.top));
    coverage.size = {static_cast<int>(std::ceil(extent.right)) - coverage.left,
                     static_cast<int>(std::ceil(extent.bottom)) - coverage.top};
    if (coverage.size.width <= 0 || coverage.size.height <= 0) return {};
    coverage.values.resize(static_cast<std::size_t>(coverage.size.width) * coverage.size.height);
    stbtt__bitmap target{coverage.size.width, coverage.size.height, coverage.size.width, coverage.values.data()};
    const float flatness = 0.05f;  // px
    stbtt_Rasterize(&target, flatness, outline.data(), static_cast<int>(outline.size()), scale, scale, shift, 0,
                    coverage.left, coverage.top, 1, nullptr);
    return coverage;
}

}  // namespace doppel

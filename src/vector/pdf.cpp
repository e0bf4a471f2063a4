#include "base/error.hpp"
#include "output/files.hpp"
#include "vector/cairo_drawing.hpp"
#include "vector/page.hpp"
#include "vector/paths.hpp"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <new>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {
namespace {

using Surface = Owned<cairo_surface_t, cairo_surface_destroy>;
using Context = Owned<cairo_t, cairo_destroy>;
using FontFace = Owned<cairo_font_face_t, cairo_font_face_destroy>;

void check(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) throw io_failed("a PDF cannot be made: {}", cairo_status_to_string(status));
}

/// The font; where it lacks the weight, FreeType makes it. It keeps FreeType until Cairo has let go of it.
FontFace load_font(const Font& font, Weight weight) {
    struct Loaded {
        FT_Library library = nullptr;
        FT_Face face = nullptr;
        ~Loaded() {
            FT_Done_Face(face);
            FT_Done_FreeType(library);
        }
    };
    auto loaded = std::make_unique<Loaded>();
    const auto file = font.bytes();
    if (FT_Init_FreeType(&loaded->library) != 0 ||
        FT_New_Memory_Face(loaded->library, reinterpret_cast<const FT_Byte*>(file.data()),
                           static_cast<FT_Long>(file.size()), font.index(), &loaded->face) != 0)
        throw io_failed("FreeType cannot read the font {}", font.file().string());
    FontFace face(cairo_ft_font_face_create_for_ft_face(loaded->face, FT_LOAD_NO_HINTING));
    static const cairo_user_data_key_t key{};
    check(cairo_font_face_set_user_data(face.get(), &key, loaded.get(),
                                        [](void* kept) { delete static_cast<Loaded*>(kept); }));
    static_cast<void>(loaded.release());
    if (font.lacks(weight)) cairo_ft_font_face_set_synthesize(face.get(), CAIRO_FT_SYNTHESIZE_BOLD);
    return face;
}

void set_color(cairo_t* to, const Color& color) {
    cairo_set_source_rgba(to, color.r, color.g, color.b, color.a);
}

/// Draws items of a page.
class Painter {
public:
    Painter(cairo_t* to, const Typeface& typeface) : to_(to), typeface_(typeface) {}

    void operator()(const Path& path) const {
        for (const auto& step : path.steps) {
            switch (step.kind) {
                case Path::Step::Kind::move:
                    cairo_move_to(to_, step.to.x, step.to.y);
                    break;
                case Path::Step::Kind::line:
                    cairo_line_to(to_, step.to.x, step.to.y);
                    break;
                case Path::Step::Kind::curve:
                    cairo_curve_to(to_, step.leave.x, step.leave.y, step.arrive.x, step.arrive.y, step.to.x, step.to.y);
                    break;
                case Path::Step::Kind::close:
                    cairo_close_path(to_);
            }
        }
        set_color(to_, path.color);
        if (path.pen == 0) return cairo_fill(to_);
        cairo_set_line_width(to_, path.pen);
        cairo_set_line_join(to_, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(to_, path.has_round_ends ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        cairo_stroke(to_);
    }

    void operator()(const Label& label) {
        const TextLine line = typeface_.lay_out(label.text, label.size, label.weight);
        const Point start = start_of(label, line);
        cairo_set_font_size(to_, label.size);
        set_color(to_, label.color);
        for (std::size_t i = 0; i < line.glyphs.size();) {
            // as far as one font has the letters
            const auto* font = line.glyphs[i].font;
            const std::size_t begin = line.glyphs[i].byte;
            std::size_t end = begin;
            std::vector<cairo_glyph_t> glyphs;
            std::vector<cairo_text_cluster_t> letters;  // a glyph each
            for (; i < line.glyphs.size() && line.glyphs[i].font == font; ++i) {
                const auto& glyph = line.glyphs[i];
                glyphs.push_back({static_cast<unsigned long>(glyph.number), start.x + glyph.pen, start.y});
                end = i + 1 < line.glyphs.size() ? line.glyphs[i + 1].byte : label.text.size();
                letters.push_back({static_cast<int>(end - glyph.byte), 1});
            }
            cairo_set_font_face(to_, face_of(*font, label.weight));
            cairo_show_text_glyphs(to_, &label.text[begin], static_cast<int>(end - begin), glyphs.data(),
                                   static_cast<int>(glyphs.size()), letters.data(), static_cast<int>(letters.size()),
                                   {});
        }
    }

    void operator()(const Image& image) const {
        const auto& pixels = *image.pixels;
        const bool is_opaque = pixels.is_opaque();
        const Surface surface(cairo_image_surface_create(is_opaque ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32,
                                                         pixels.size.width, pixels.size.height));
        check(cairo_surface_status(surface.get()));
        cairo_surface_flush(surface.get());
        auto* bytes = cairo_image_surface_get_data(surface.get());
        const int stride = cairo_image_surface_get_stride(surface.get());
        for (int y = 0; y < pixels.size.height; ++y) {
            auto* row = reinterpret_cast<std::uint32_t*>(bytes + std::ptrdiff_t{y} * stride);
            for (int x = 0; x < pixels.size.width; ++x) {
                const auto* p = pixels.at(x, y);
                const std::uint32_t a = p[3];
                const auto times = [&](std::uint32_t v) { return (v * a + 127) / 255; };
                row[x] = a << 24 | times(p[0]) << 16 | times(p[1]) << 8 | times(p[2]);
            }
        }
        cairo_surface_mark_dirty(surface.get());
        cairo_save(to_);
        cairo_translate(to_, image.left, image.top);
        cairo_scale(to_, (image.right - image.left) / static_cast<float>(pixels.size.width),
                    (image.bottom - image.top) / static_cast<float>(pixels.size.height));
        cairo_set_source_surface(to_, surface.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(to_), CAIRO_FILTER_NEAREST);
        cairo_paint(to_);
        cairo_restore(to_);
    }

private:
    cairo_font_face_t* face_of(const Font& font, Weight weight) {
        auto& face = faces_[{&font, weight}];
        if (!face) face = load_font(font, weight);
        return face.get();
    }

    cairo_t* to_;
    const Typeface& typeface_;
    std::map<std::pair<const Font*, Weight>, FontFace> faces_;
};

cairo_status_t append(void* file, const unsigned char* bytes, unsigned count) try {
    static_cast<std::string*>(file)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
} catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
}

void describe(cairo_surface_t* surface, const Metadata& metadata) {
    const auto set = [&](std::string_view key, cairo_pdf_metadata_t entry) {
        cairo_pdf_surface_set_metadata(surface, entry, text_of(metadata, key).c_str());
    };
    set("title", CAIRO_PDF_METADATA_TITLE);
    set("artist", CAIRO_PDF_METADATA_AUTHOR);
    set("comment", CAIRO_PDF_METADATA_SUBJECT);
    set("encoder", CAIRO_PDF_METADATA_CREATOR);
}

}  // namespace

void draw(const DisplayList& list, const Typeface& typeface, cairo_t* to) {
    Painter painter(to, typeface);
    for (const auto& item : page_items(list)) std::visit(painter, item);
    check(cairo_status(to));
}

std::string pdf_page(const DisplayList& list, const Page& page) {
    std::string file;
    const double scale = page.width_pt / page.size.width;
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &file, page.width_pt, scale * page.size.height));
    check(cairo_surface_status(surface.get()));
    describe(surface.get(), page.metadata);
    cairo_pdf_surface_restrict_to_version(surface.get(), CAIRO_PDF_VERSION_1_5);  // newer Cairos write 1.7
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    {
        const Context context(cairo_create(surface.get()));
        cairo_scale(context.get(), scale, scale);
        draw(list, page.typeface, context.get());
        cairo_show_page(context.get());
        check(cairo_status(context.get()));
    }
    cairo_surface_finish(surface.get());
    check(cairo_surface_status(surface.get()));
    // what a PDF holds may be compressed; what follows it is free
    file.resize(file.rfind("%%EOF"));
    return file + fmt::format("%%EOF\n% {}\n", maker_of(page.metadata));
}

}  // namespace doppel

#include "plot/page.hpp"

#include "base/error.hpp"
#include "base/owned.hpp"
#include "base/text.hpp"
#include "render/stroke.hpp"

#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <new>
#include <numbers>
#include <utility>

namespace doppel {
namespace {

using CairoSurface = Owned<cairo_surface_t, cairo_surface_destroy>;

/// Throws Error (exit 4).
void check_cairo(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS) throw io_failed("a page cannot be drawn: {}", cairo_status_to_string(status));
}

using CairoFontFace = Owned<cairo_font_face_t, cairo_font_face_destroy>;

/// The font for Cairo. FreeType lives until Cairo has released the font.
CairoFontFace load_font(const Font& font) {
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
    CairoFontFace face(cairo_ft_font_face_create_for_ft_face(loaded->face, FT_LOAD_NO_HINTING));
    static const cairo_user_data_key_t key{};
    check_cairo(cairo_font_face_set_user_data(face.get(), &key, loaded.get(),
                                              [](void* kept) { delete static_cast<Loaded*>(kept); }));
    static_cast<void>(loaded.release());
    return face;
}

/// The picture in Cairo's format: premultiplied 32-bit words in native byte order.
CairoSurface surface_of(const Picture& pixels) {
    CairoSurface surface(cairo_image_surface_create(pixels.is_opaque() ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32,
                                                    pixels.size.width, pixels.size.height));
    check_cairo(cairo_surface_status(surface.get()));
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
    return surface;
}

/// The rings of a glow from the outside in, each `beyond` px outside the shape's edge, with its opacity. Their sum
/// falls with the square of the distance, from 1/3 at the edge.
template <class Add>
void for_each_ring(float reach, const Add& add) {
    constexpr int rings = 6;
    const auto light = [](float share) { return (1 - share) * (1 - share) / 3; };
    for (int k = rings; k-- > 0;) {
        const float inner = light((static_cast<float>(k) + 0.5f) / rings);
        const float outer = k + 1 < rings ? light((static_cast<float>(k) + 1.5f) / rings) : 0;
        add(reach * static_cast<float>(k + 1) / rings, (inner - outer) / (1 - outer));
    }
}

/// A part of a stroke with constant opacity, width and glow.
struct Part {
    std::vector<Point> line;
    float alpha, width, glow;  // alpha 0…1; px

    bool continues_with(Point from, const Part& next) const {
        return line.back().x == from.x && line.back().y == from.y && alpha == next.alpha && width == next.width &&
               glow == next.glow;
    }
};

/// Bends become chords with errors of at most 1/20 px; changes of opacity and width become steps of 4 %.
std::vector<Part> parts_of(const Stroke& stroke) {
    std::vector<Part> parts;
    for (std::size_t i = 0; i + 1 < stroke.vertices.size(); ++i) {
        const auto &from = stroke.vertices[i], &to = stroke.vertices[i + 1];
        const Chord chord(from.at, to.at);
        if (!(chord.length > 0)) continue;
        const float bends = std::sqrt(std::abs(from.bend) / 0.05f);
        const float part = std::max({std::abs(to.alpha - from.alpha), std::abs(to.width - from.width),
                                     std::abs(to.glow - from.glow)}) /
                           0.04f;
        const int count = std::max(1, static_cast<int>(std::ceil(std::max(bends, part))));
        const auto at = [&](int k) {
            const float share = static_cast<float>(k) / static_cast<float>(count);
            const float along = share * chord.length, right = 4 * share * (1 - share) * from.bend;
            return Point{from.at.x + chord.axis.x * along - chord.axis.y * right,
                         from.at.y + chord.axis.y * along + chord.axis.x * right};
        };
        for (int k = 0; k < count; ++k) {
            const float share = (static_cast<float>(k) + 0.5f) / static_cast<float>(count);
            Part next{{at(k), at(k + 1)},
                      std::lerp(from.alpha, to.alpha, share),
                      stroke.width * std::lerp(from.width, to.width, share),
                      stroke.glow * std::lerp(from.glow, to.glow, share)};
            if (!parts.empty() && parts.back().continues_with(next.line[0], next))
                parts.back().line.push_back(next.line[1]);
            else
                parts.push_back(std::move(next));
        }
    }
    std::erase_if(parts, [&](const Part& part) { return !(stroke.color.a * part.alpha > 0); });
    return parts;
}

void add_circle(cairo_t* to, Point center, float radius) {
    cairo_new_sub_path(to);
    cairo_arc(to, center.x, center.y, radius, 0, 2 * std::numbers::pi);
    cairo_close_path(to);
}

void add_line(cairo_t* to, const std::vector<Point>& line) {
    for (std::size_t i = 0; i < line.size(); ++i) (i == 0 ? cairo_move_to : cairo_line_to)(to, line[i].x, line[i].y);
}

/// Draws the items of a page. A stroke has a path for each part of constant opacity and width; glows are stacks of wide
/// faint paths.
class PagePainter {
public:
    PagePainter(cairo_t* to, const Page& page, bool pixels)
        : to_(to), typeface_(page.typeface), scale_(page.scale), pixels_(pixels) {}

    void operator()(const Box& box) {
        if (!(box.right > box.left && box.bottom > box.top)) return;
        const float r = std::clamp(box.corner, 0.f, std::min(box.right - box.left, box.bottom - box.top) / 2);
        if (r == 0) {
            cairo_rectangle(to_, box.left, box.top, box.right - box.left, box.bottom - box.top);
        } else {
            constexpr double quarter = std::numbers::pi / 2;
            cairo_new_sub_path(to_);
            cairo_arc(to_, box.right - r, box.top + r, r, -quarter, 0);
            cairo_arc(to_, box.right - r, box.bottom - r, r, 0, quarter);
            cairo_arc(to_, box.left + r, box.bottom - r, r, quarter, 2 * quarter);
            cairo_arc(to_, box.left + r, box.top + r, r, 2 * quarter, 3 * quarter);
            cairo_close_path(to_);
        }
        fill(box.color);
    }

    void operator()(const Capsule& capsule) {
        if (!(capsule.radius > 0)) return;
        const auto add = [&](float radius, const Color& color) {
            if (distance(capsule.from, capsule.to) > 0) {
                add_line(to_, {capsule.from, capsule.to});
                stroke(2 * radius, color);
            } else {
                add_circle(to_, capsule.from, radius);
                fill(color);
            }
        };
        if (capsule.glow > 0)
            for_each_ring(capsule.glow, [&](float beyond, float alpha) {
                add(capsule.radius + beyond, capsule.color.with_alpha(capsule.color.a * alpha));
            });
        add(capsule.radius, capsule.color);
    }

    void operator()(const Ring& ring) {
        if (!(ring.radius >= 0 && ring.width > 0)) return;
        add_circle(to_, ring.center, ring.radius);
        stroke(ring.width, ring.color);
    }

    void operator()(const Stroke& stroke) {
        if (!(stroke.color.a > 0 && stroke.width > 0)) return;
        const auto parts = parts_of(stroke);
        for (const auto& part : parts) {
            if (!(part.glow > 0.5f)) continue;
            for_each_ring(part.glow, [&](float beyond, float alpha) {
                add_line(to_, part.line);
                this->stroke(part.width + 2 * beyond, stroke.color.with_alpha(stroke.color.a * part.alpha * alpha),
                             CAIRO_LINE_CAP_BUTT);
            });
        }
        for (const auto& part : parts) {
            const auto color = stroke.color.with_alpha(stroke.color.a * part.alpha);
            add_line(to_, part.line);
            // transparent parts must not overlap
            this->stroke(part.width, color, color.a == 1 ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        }
    }

    void operator()(const Polylines& polylines) {
        cairo_save(to_);
        if (polylines.within) clip(*polylines.within);
        for (const auto& line : polylines.lines) {
            add_line(to_, line);
            if (polylines.width == 0) cairo_close_path(to_);
        }
        const double dashes[] = {polylines.dash, polylines.gap};
        cairo_set_dash(to_, dashes, polylines.dash > 0 ? 2 : 0, 0);
        polylines.width == 0 ? fill(polylines.color) : stroke(polylines.width, polylines.color);
        cairo_restore(to_);
    }

    void operator()(const Label& label) {
        const TextLine line = typeface_.lay_out(label.text, label.size, label.weight);
        Point start = start_of(label, line);
        start.y = std::round(label.anchor.y * scale_) / scale_;
        cairo_set_font_size(to_, label.size);
        for (std::size_t i = 0; i < line.glyphs.size();) {
            // a run of letters in the same font
            const auto* font = line.glyphs[i].font;
            const std::size_t begin = line.glyphs[i].byte;
            std::size_t end = begin;
            std::vector<cairo_glyph_t> glyphs;
            std::vector<cairo_text_cluster_t> letters;  // one glyph each
            for (; i < line.glyphs.size() && line.glyphs[i].font == font; ++i) {
                const auto& glyph = line.glyphs[i];
                glyphs.push_back({static_cast<unsigned long>(glyph.number), start.x + glyph.pen, start.y});
                end = i + 1 < line.glyphs.size() ? line.glyphs[i + 1].byte : label.text.size();
                letters.push_back({static_cast<int>(end - glyph.byte), 1});
            }
            cairo_set_font_face(to_, face_of(*font));
            if (pixels_) {
                cairo_glyph_path(to_, glyphs.data(), static_cast<int>(glyphs.size()));
                fill(label.color);
                continue;
            }
            cairo_set_source_rgba(to_, label.color.r, label.color.g, label.color.b, label.color.a);
            cairo_show_text_glyphs(to_, &label.text[begin], static_cast<int>(end - begin), glyphs.data(),
                                   static_cast<int>(glyphs.size()), letters.data(), static_cast<int>(letters.size()),
                                   {});
        }
    }

    void operator()(const Image& image) {
        const auto whole = [&](float at) { return std::round(at * scale_) / scale_; };  // whole pixels, as in a picture
        const auto [left, top, right, bottom] = image.at;
        const Area at = image.within ? image.at : Area{whole(left), whole(top), whole(right), whole(bottom)};
        if (at.width() == 0 || at.height() == 0 || !image.pixels) return;
        const float columns = static_cast<float>(image.pixels->size.width),
                    rows = static_cast<float>(image.pixels->size.height);
        const bool is_fine = std::abs(at.width()) * scale_ < columns || std::abs(at.height()) * scale_ < rows;
        const auto surface = surface_of(*image.pixels);
        cairo_save(to_);
        if (image.within) clip(*image.within);
        cairo_translate(to_, at.left, at.top);
        cairo_scale(to_, at.width() / columns, at.height() / rows);
        cairo_set_source_surface(to_, surface.get(), 0, 0);
        cairo_pattern_set_filter(cairo_get_source(to_),
                                 image.within && is_fine ? CAIRO_FILTER_GOOD : CAIRO_FILTER_NEAREST);
        cairo_pattern_set_extend(cairo_get_source(to_), CAIRO_EXTEND_PAD);  // so that the edges do not fade out
        cairo_rectangle(to_, 0, 0, columns, rows);
        cairo_fill(to_);
        cairo_restore(to_);
    }

private:
    void fill(const Color& color) {
        cairo_set_source_rgba(to_, color.r, color.g, color.b, color.a);
        cairo_fill(to_);
    }

    void stroke(float width, const Color& color, cairo_line_cap_t cap = CAIRO_LINE_CAP_ROUND) {
        cairo_set_source_rgba(to_, color.r, color.g, color.b, color.a);
        cairo_set_line_width(to_, width);
        cairo_set_line_join(to_, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_cap(to_, cap);
        cairo_stroke(to_);
    }

    void clip(const Area& area) {
        cairo_rectangle(to_, area.left, area.top, area.width(), area.height());
        cairo_clip(to_);
    }

    cairo_font_face_t* face_of(const Font& font) {
        auto& face = faces_[&font];
        if (!face) face = load_font(font);
        return face.get();
    }

    cairo_t* to_;
    const Typeface& typeface_;
    float scale_;  // px per unit of the items
    bool pixels_;
    std::map<const Font*, CairoFontFace> faces_;
};

/// Draws the page with `units` of the surface per pixel of the page. With `pixels`, letters are drawn as paths at
/// subpixel positions, because not every version of Cairo supports those for text.
void draw(const Page& page, cairo_surface_t* surface, double units, bool pixels, const std::atomic<bool>& stop) {
    check_cairo(cairo_surface_status(surface));
    const Owned<cairo_t, cairo_destroy> context(cairo_create(surface));
    cairo_scale(context.get(), units * page.scale, units * page.scale);
    PagePainter painter(context.get(), page, pixels);
    for (const auto& item : page.items) {
        throw_if_set(stop);
        std::visit(painter, item);
    }
    if (!pixels) cairo_show_page(context.get());
    check_cairo(cairo_status(context.get()));
}

/// The text of this key in the metadata; empty if there is none.
std::string text_of(const Metadata& metadata, std::string_view key) {
    const auto found =
        std::ranges::find(metadata, key, [](const auto& entry) -> std::string_view { return entry.first; });
    return found == metadata.end() ? "" : found->second;
}

cairo_status_t append(void* file, const unsigned char* bytes, unsigned count) try {
    static_cast<std::string*>(file)->append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
} catch (const std::bad_alloc&) {
    return CAIRO_STATUS_NO_MEMORY;
}

void describe_pdf(cairo_surface_t* surface, const Metadata& metadata) {
    const auto set = [&](std::string_view key, cairo_pdf_metadata_t entry) {
        cairo_pdf_surface_set_metadata(surface, entry, text_of(metadata, key).c_str());
    };
    set("title", CAIRO_PDF_METADATA_TITLE);
    set("artist", CAIRO_PDF_METADATA_AUTHOR);
    set("comment", CAIRO_PDF_METADATA_SUBJECT);
    set("encoder", CAIRO_PDF_METADATA_CREATOR);
    cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
    cairo_pdf_surface_restrict_to_version(surface, CAIRO_PDF_VERSION_1_5);  // newer versions of Cairo would write 1.7
}

}  // namespace

std::string page_library() {
    return fmt::format("Cairo {}", cairo_version_string());
}

PageList page_list(const DisplayList& list) {
    PageList items;
    for (const auto& item : list) std::visit([&](const auto& one) { items.emplace_back(one); }, item);
    return items;
}

Picture picture_of(const Page& page, const std::atomic<bool>& stop) {
    const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, page.size.width, page.size.height));
    draw(page, surface.get(), 1, true, stop);
    cairo_surface_flush(surface.get());
    Picture picture(page.size);
    const auto* bytes = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < page.size.height; ++y) {
        const auto* row = reinterpret_cast<const std::uint32_t*>(bytes + std::ptrdiff_t{y} * stride);
        for (int x = 0; x < page.size.width; ++x) {
            auto* p = picture.at(x, y);
            for (int channel = 0; channel < 3; ++channel)
                p[channel] = static_cast<std::uint8_t>(row[x] >> (16 - 8 * channel));
            p[3] = 255;
        }
    }
    return picture;
}

std::string page_file(const Page& page, PictureFormat format, double width_pt, const Metadata& metadata) {
    std::string file;
    const bool is_pdf = format == PictureFormat::pdf;
    const double units = width_pt / page.size.width;
    const auto create = is_pdf ? cairo_pdf_surface_create_for_stream : cairo_svg_surface_create_for_stream;
    const CairoSurface surface(create(append, &file, width_pt, units * page.size.height));
    check_cairo(cairo_surface_status(surface.get()));
    if (is_pdf)
        describe_pdf(surface.get(), metadata);
    else
        cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PT);
    const std::atomic<bool> never = false;
    draw(page, surface.get(), units, false, never);
    cairo_surface_finish(surface.get());
    check_cairo(cairo_surface_status(surface.get()));
    auto maker = text_of(metadata, "encoder");  // "Doppel …", by which made_by() recognises it
    if (!maker.starts_with("Doppel")) maker = "Doppel";
    if (is_pdf) {  // the contents of a PDF may be compressed; a comment at its end is not
        file.resize(file.rfind("%%EOF"));
        return file + fmt::format("%%EOF\n% {}\n", maker);
    }
    const std::size_t root = file.find("<svg"), inside = file.find('>', root) + 1;
    return fmt::format("{}<!-- {} -->\n{}\n<title>{}</title>\n<desc>{}</desc>{}", file.substr(0, root), maker,
                       file.substr(root, inside - root), markup(text_of(metadata, "title")),
                       markup(text_of(metadata, "comment")), file.substr(inside));
}

}  // namespace doppel

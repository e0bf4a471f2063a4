#include "plot/page.hpp"

#include "base/text.hpp"
#include "plot/page_painter.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <new>

namespace doppel {
namespace {

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

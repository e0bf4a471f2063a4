#pragma once

#include "base/error.hpp"
#include "plot/page.hpp"

#include <cairo.h>

#include <map>
#include <memory>
#include <utility>

namespace doppel {

template <auto destroy>
struct CairoDestroy {
    template <class T>
    void operator()(T* object) const {
        destroy(object);
    }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, CairoDestroy<cairo_surface_destroy>>;
using CairoContext = std::unique_ptr<cairo_t, CairoDestroy<cairo_destroy>>;
using CairoFontFace = std::unique_ptr<cairo_font_face_t, CairoDestroy<cairo_font_face_destroy>>;

/// Throws Error (exit 4) if Cairo failed.
void check_cairo(cairo_status_t status);

/// Draws the items of a page (page_painter.cpp). Circles are Cairo's arcs. A stroke of constant opacity and width is
/// one path; others have a path for each part. Glows are stacks of wide faint paths.
class PagePainter {
public:
    /// The items have the units of `to`, which are `scale` pixels. With `pixels`, letters are drawn as images at
    /// subpixel positions, which not every version of Cairo supports for text.
    PagePainter(cairo_t* to, const Typeface& typeface, float scale, bool pixels)
        : to_(to), typeface_(typeface), scale_(scale), pixels_(pixels) {}

    void operator()(const Box& box);
    void operator()(const Capsule& capsule);
    void operator()(const Ring& ring);
    void operator()(const Stroke& stroke);
    void operator()(const Label& label);
    void operator()(const Image& image);
    void operator()(const Polylines& polylines);
    void operator()(const CellImage& cells);

private:
    void fill(const Color& color);
    void stroke(float width, const Color& color, cairo_line_cap_t cap = CAIRO_LINE_CAP_ROUND);
    void clip(const Area& area);
    void paint(const Picture& pixels, const Area& at, cairo_filter_t filter);
    cairo_font_face_t* face_of(const Font& font, Weight weight);

    cairo_t* to_;
    const Typeface& typeface_;
    float scale_;
    bool pixels_;
    std::map<std::pair<const Font*, Weight>, CairoFontFace> faces_;
};

}  // namespace doppel

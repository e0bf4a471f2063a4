#pragma once

#include "plot/page.hpp"

#include <cairo.h>

#include <atomic>
#include <memory>

namespace doppel {

template <auto destroy>
struct CairoDestroy {
    void operator()(auto* object) const { destroy(object); }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, CairoDestroy<cairo_surface_destroy>>;

/// Throws Error (exit 4) if Cairo failed.
void check_cairo(cairo_status_t status);

/// Draws the page with `units` of the surface per pixel of the page. With `pixels`, letters are drawn as paths at
/// subpixel positions, because not every version of Cairo supports those for text. Throws Error: exit 4 if Cairo
/// failed, exit 130 soon after `stop` is set.
void draw(const Page& page, cairo_surface_t* surface, double units, bool pixels, const std::atomic<bool>& stop);

}  // namespace doppel

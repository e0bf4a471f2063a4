#pragma once

#include "render/typeface.hpp"

#include <cairo.h>

namespace doppel {

/// Draws the list, px as Cairo's units. Throws Error (exit 4) where there is no memory.
void draw(const DisplayList& list, const Typeface& typeface, cairo_t* to);

}  // namespace doppel

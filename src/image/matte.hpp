#pragma once

#include "image/picture.hpp"

namespace doppel {

/// Undoes a background: from the same picture on black and on white, within the rectangle, the colours with their
/// opacity (not premultiplied) that give both back where a viewer lays them over it in sRGB. Exact on black, and on
/// white where all channels agree on the opacity; edges that were blended in linear light come out a little darker
/// there. All of one size.
void matte(const Picture& black, const Picture& white, const Rect& within, Picture& into);

}  // namespace doppel

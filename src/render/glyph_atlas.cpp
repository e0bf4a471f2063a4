#include "render/glyph_atlas.hpp"

#include "base/error.hpp"

#include <algorithm>

namespace doppel {

const GlyphAtlas::Slot& GlyphAtlas::slot(const TextLine::Glyph& glyph, float size, Weight weight, int subpixel) {
    const Key key{glyph.font, glyph.number, size, weight, subpixel};
    if (const auto found = slots_.find(key); found != slots_.end()) return found->second;

    const Coverage drawn = glyph.font->rasterised(glyph.number, size, weight, static_cast<float>(subpixel) / subpixels);
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
    if (const int rows = shelf_ + shelf_height_; rows > height())
        values_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
    const Slot slot{drawn.left, drawn.top, drawn.size, pen_, shelf_};
    for (int row = 0; row < drawn.size.height; ++row)
        std::copy_n(&drawn.values[static_cast<std::size_t>(row) * drawn.size.width], drawn.size.width,
                    &values_[static_cast<std::size_t>(shelf_ + row) * width + pen_]);
    pen_ += drawn.size.width;
    return slots_.emplace(key, slot).first->second;
}

}  // namespace doppel

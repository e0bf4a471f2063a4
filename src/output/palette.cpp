#include "output/palette.hpp"

#include <libimagequant.h>

#include <new>
#include <stdexcept>

namespace doppel {
namespace {

struct FreeImage {
    void operator()(liq_image* image) const { liq_image_destroy(image); }
};

/// No copy: it looks at `rgba` while it lives.
std::unique_ptr<liq_image, FreeImage> image_of(const liq_attr& attributes, const std::uint8_t* rgba, Size size) {
    std::unique_ptr<liq_image, FreeImage> image(liq_image_create_rgba(&attributes, rgba, size.width, size.height, 0));
    if (!image) throw std::bad_alloc();
    return image;
}

void check(liq_error error) {
    if (error == LIQ_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != LIQ_OK) throw std::logic_error("libimagequant refuses its task");
}

}  // namespace

void Palette::Free::operator()(liq_attr* attributes) const {
    liq_attr_destroy(attributes);
}
void Palette::Free::operator()(liq_histogram* histogram) const {
    liq_histogram_destroy(histogram);
}
void Palette::Free::operator()(liq_result* result) const {
    liq_result_destroy(result);
}

Palette::Palette() : attributes_(liq_attr_create()) {
    if (!attributes_) throw std::bad_alloc();
    check(liq_set_max_colors(attributes_.get(), 255));
    histogram_.reset(liq_histogram_create(attributes_.get()));
    if (!histogram_) throw std::bad_alloc();
}

Palette::~Palette() = default;

void Palette::count(const std::uint8_t* rgba, Size size) {
    const auto image = image_of(*attributes_, rgba, size);
    check(liq_histogram_add_image(histogram_.get(), attributes_.get(), image.get()));
}

void Palette::choose() {
    liq_result* result = nullptr;
    check(liq_histogram_quantize(histogram_.get(), attributes_.get(), &result));
    result_.reset(result);
    histogram_.reset();
    check(liq_set_dithering_level(result, 0));
}

std::array<std::uint32_t, 256> Palette::argb() const {
    std::array<std::uint32_t, 256> entries{};
    const liq_palette& palette = *liq_get_palette(result_.get());
    for (unsigned i = 0; i < palette.count; ++i) {
        const auto [r, g, b, a] = palette.entries[i];
        entries[i] = 0xff000000u | std::uint32_t{r} << 16 | std::uint32_t{g} << 8 | b;
    }
    // opaque black: what is not needed must not be taken for the transparent one
    for (unsigned i = palette.count; i < 255; ++i) entries[i] = 0xff000000u;
    return entries;
}

void Palette::look_up(const std::uint8_t* rgba, Size size, std::uint8_t* index) {
    const auto image = image_of(*attributes_, rgba, size);
    check(liq_write_remapped_image(result_.get(), image.get(), index, std::size_t(size.width) * size.height));
}

}  // namespace doppel

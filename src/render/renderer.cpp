#include "render/renderer.hpp"

#include "base/error.hpp"
#include "render/gl_context.hpp"
#include "render/gl_painter.hpp"

#include <algorithm>
#include <new>
#include <utility>

namespace doppel {
namespace {

/// The regions in groups to draw at once. Large pictures are drawn in bands, so that a stop takes effect soon.
std::vector<std::vector<Rect>> bands(const std::vector<Rect>& regions) {
    constexpr long maximum = 16'000'000;  // px
    long pixels = 0;
    for (const Rect& r : regions) pixels += r.area();
    if (pixels <= maximum) return {regions};
    std::vector<std::vector<Rect>> result;
    for (const Rect& r : regions) {
        const int rows = std::max(1, static_cast<int>(maximum / std::max(1, r.right - r.left)));
        for (int top = r.top; top < r.bottom; top += rows)
            result.push_back({{r.left, top, r.right, std::min(top + rows, r.bottom)}});
    }
    return result;
}

}  // namespace

Renderer::Renderer(Size size, const DisplayList& backdrop, Gl gl, const std::atomic<bool>& stop,
                   const Typeface& typeface) try
    : size_(size), context_(make_context(gl)) {
    GLint maximum = 0;
    gl::GetIntegerv(GL_MAX_TEXTURE_SIZE, &maximum);
    if (size.width < 1 || size.height < 1 || size.width > maximum || size.height > maximum)
        throw io_failed("OpenGL draws pictures of 1 to {} px a side; {} × {} px is none", maximum, size.width,
                        size.height);
    atlas_.emplace(maximum, typeface);
    painter_ = std::make_unique<gl::Painter>(size);
    picture_ = Picture(size);
    throw_if_set(stop);
    backdrop_ = Picture(size);
    gl::PixelStorei(GL_PACK_ROW_LENGTH, size.width);

    gl::ClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    gl::Clear(GL_COLOR_BUFFER_BIT);
    make_render_list(backdrop, size, *atlas_, now_);
    for (const auto& regions : bands({all_of(size)})) {
        throw_if_set(stop);
        paint(regions, backdrop_);
    }
} catch (const std::bad_alloc&) {
    throw io_failed("there is no memory for a picture of {} × {} px", size.width, size.height);
}

Renderer::~Renderer() = default;

const Picture& Renderer::draw(const DisplayList& list, const std::atomic<bool>& stop) {
    context_->make_current();
    make_render_list(list, size_, *atlas_, now_);
    changed_ = first_ ? std::vector{all_of(size_)} : dirty_regions(last_, now_);
    first_ = true;  // until this picture is complete

    // Each switch between upload, drawing and reading makes OpenGL finish, so there is one of each per band. The
    // backdrop is restored from memory: a blit would be drawing, and would finish for every rectangle.
    for (const auto& regions : bands(changed_)) {
        throw_if_set(stop);
        gl::PixelStorei(GL_UNPACK_ROW_LENGTH, size_.width);
        for (const Rect& r : regions) painter_->put(backdrop_, r);
        paint(regions, picture_);
    }
    std::swap(last_, now_);
    first_ = false;
    return picture_;
}

std::string Renderer::description() const {
    context_->make_current();
    const auto text = [](GLenum name) { return reinterpret_cast<const char*>(gl::GetString(name)); };
    return fmt::format("{}, {}, OpenGL {}", context_->library(), text(GL_RENDERER), text(GL_VERSION));
}

void Renderer::paint(const std::vector<Rect>& regions, Picture& into) {
    painter_->paint(now_, regions, *atlas_);
    for (const Rect& r : regions)
        gl::ReadPixels(r.left, r.top, r.right - r.left, r.bottom - r.top, GL_RGBA, GL_UNSIGNED_BYTE,
                       into.at(r.left, r.top));
    gl::check_errors(fmt::format("drawing a picture of {} × {} px", size_.width, size_.height));
}

}  // namespace doppel

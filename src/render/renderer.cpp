#include "render/renderer.hpp"

#include "base/error.hpp"
#include "render/gl_context.hpp"
#include "render/gl_painter.hpp"
#include "render/render_list.hpp"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

namespace doppel {

class Renderer::State {
public:
    State(Size size, const DisplayList& backdrop, Gl gl, const std::atomic<bool>& stop, const Typeface& typeface)
        : size_(size), context_(make_context(gl)) {
        check_size();
        atlas_.emplace(limit(GL_MAX_TEXTURE_SIZE), typeface);
        canvas_.emplace(size);
        painter_.emplace(size);
        picture_ = Picture(size);
        throw_if_set(stop);
        backdrop_ = Picture(size);
        gl::PixelStorei(GL_PACK_ROW_LENGTH, size.width);

        gl::ClearColor(0, 0, 0, 1);
        gl::Clear(GL_COLOR_BUFFER_BIT);
        make_render_list(backdrop, size, *atlas_, now_);
        for (const auto& regions : bands({all_of(size)})) {
            throw_if_set(stop);
            paint(regions, backdrop_);
        }
    }

    ~State() { context_->make_current(); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    const Picture& draw(const DisplayList& list, const std::atomic<bool>& stop) {
        context_->make_current();
        make_render_list(list, size_, *atlas_, now_);
        changed_ = first_ ? std::vector{all_of(size_)} : dirty_regions(last_, now_);
        first_ = true;  // until this picture is complete

        // Each switch between upload, drawing and reading makes OpenGL finish, so there is one of each per band. The
        // backdrop is restored from memory: a blit would be drawing, and would finish for every rectangle.
        for (const auto& regions : bands(changed_)) {
            throw_if_set(stop);
            gl::PixelStorei(GL_UNPACK_ROW_LENGTH, size_.width);
            for (const Rect& r : regions) canvas_->put(backdrop_, r);
            paint(regions, picture_);
        }
        std::swap(last_, now_);
        first_ = false;
        return picture_;
    }

    const std::vector<Rect>& changed() const { return changed_; }

    std::string description() const {
        context_->make_current();
        const auto text = [](GLenum name) { return reinterpret_cast<const char*>(gl::GetString(name)); };
        return fmt::format("{}, {}, OpenGL {}", context_->library(), text(GL_RENDERER), text(GL_VERSION));
    }

private:
    /// The regions in groups to draw at once. Large pictures are drawn in bands, so that a stop takes effect soon.
    static std::vector<std::vector<Rect>> bands(const std::vector<Rect>& regions) {
        constexpr long maximum = 16'000'000;  // px
        long pixels = 0;
        for (const Rect& r : regions) pixels += long{r.right - r.left} * (r.bottom - r.top);
        if (pixels <= maximum) return {regions};
        std::vector<std::vector<Rect>> result;
        for (const Rect& r : regions) {
            const int rows = std::max(1, static_cast<int>(maximum / std::max(1, r.right - r.left)));
            for (int top = r.top; top < r.bottom; top += rows)
                result.push_back({{r.left, top, r.right, std::min(top + rows, r.bottom)}});
        }
        return result;
    }

    /// Draws the current render list inside `regions`, and reads the pixels back.
    void paint(const std::vector<Rect>& regions, Picture& into) {
        painter_->paint(now_, regions, *atlas_);
        for (const Rect& r : regions)
            gl::ReadPixels(r.left, r.top, r.right - r.left, r.bottom - r.top, GL_RGBA, GL_UNSIGNED_BYTE,
                           into.at(r.left, r.top));
        gl::check_errors(fmt::format("drawing a picture of {} × {} px", size_.width, size_.height));
    }

    static int limit(GLenum name) {
        GLint value = 0;
        gl::GetIntegerv(name, &value);
        return value;
    }

    void check_size() const {
        const int maximum = limit(GL_MAX_TEXTURE_SIZE);
        if (size_.width < 1 || size_.height < 1 || size_.width > maximum || size_.height > maximum) {
            throw io_failed("OpenGL draws pictures of 1 to {} px a side; {} × {} px is none", maximum, size_.width,
                            size_.height);
        }
    }

    Size size_;
    std::unique_ptr<Context> context_;
    std::optional<GlyphAtlas> atlas_;
    std::optional<gl::Canvas> canvas_;
    std::optional<gl::Painter> painter_;
    Picture backdrop_, picture_;
    RenderList last_, now_;  // of the last picture; of the current one
    bool first_ = true;
    std::vector<Rect> changed_;
};

Renderer::Renderer(Size size, const DisplayList& backdrop, Gl gl, const std::atomic<bool>& stop,
                   const Typeface& typeface) try
    : state_(std::make_unique<State>(size, backdrop, gl, stop, typeface)) {
} catch (const std::bad_alloc&) {
    throw io_failed("there is no memory for a picture of {} × {} px", size.width, size.height);
}
Renderer::~Renderer() = default;
const Picture& Renderer::draw(const DisplayList& list, const std::atomic<bool>& stop) {
    return state_->draw(list, stop);
}
const std::vector<Rect>& Renderer::changed() const {
    return state_->changed();
}
std::string Renderer::description() const {
    return state_->description();
}

}  // namespace doppel

#include "numeric/error.hpp"
#include "picture/damage.hpp"
#include "picture/gl_context.hpp"
#include "picture/gl_painter.hpp"
#include "picture/renderer.hpp"

#include <optional>
#include <utility>

namespace doppel {

/// What the renderer is made of: a context, a canvas, the backdrop, and the sketch of the last picture.
class Renderer::Machine {
public:
    Machine(Size size, const DisplayList& backdrop, Gl gl) : size_(size), context_(make_context(gl)) {
        check_size();
        atlas_.emplace(limit(GL_MAX_TEXTURE_SIZE));
        canvas_.emplace(size);
        painter_.emplace(size);
        picture_ = backdrop_ = Picture(size);
        gl::PixelStorei(GL_PACK_ROW_LENGTH, size.width);

        gl::ClearColor(0, 0, 0, 1);
        gl::Clear(GL_COLOR_BUFFER_BIT);
        sketch(backdrop, size, *atlas_, now_);
        painter_->paint(now_, {whole()}, *atlas_);
        read(whole(), backdrop_);
    }

    ~Machine() { context_->make_current(); }
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    const Picture& draw(const DisplayList& list) {
        context_->make_current();
        sketch(list, size_, *atlas_, now_);
        changed_ = first_ ? std::vector{whole()} : damage(last_, now_);
        first_ = false;

        // each switch between putting back, drawing and reading makes OpenGL finish what it has in hand: one of each a
        // picture. Putting back from memory is a mere copy; a blit would draw, and finish, for every rectangle.
        gl::PixelStorei(GL_UNPACK_ROW_LENGTH, size_.width);
        for (const Rect& r : changed_) canvas_->put(backdrop_, r);
        painter_->paint(now_, changed_, *atlas_);
        std::swap(last_, now_);
        for (const Rect& r : changed_) read(r, picture_);
        return picture_;
    }

    const std::vector<Rect>& changed() const { return changed_; }

    std::string description() const {
        context_->make_current();
        const auto text = [](GLenum name) { return reinterpret_cast<const char*>(gl::GetString(name)); };
        return fmt::format("{}, {}, OpenGL {}", context_->library(), text(GL_RENDERER), text(GL_VERSION));
    }

private:
    Rect whole() const { return {0, 0, size_.width, size_.height}; }

    static void read(const Rect& r, Picture& into) {
        gl::ReadPixels(r.left, r.top, r.right - r.left, r.bottom - r.top, GL_RGBA, GL_UNSIGNED_BYTE,
                       into.at(r.left, r.top));
    }

    static int limit(GLenum name) {
        GLint value = 0;
        gl::GetIntegerv(name, &value);
        return value;
    }

    void check_size() const {
        const int most = limit(GL_MAX_TEXTURE_SIZE);
        if (size_.width < 1 || size_.height < 1 || size_.width > most || size_.height > most) {
            throw io_failed("OpenGL draws pictures of 1 to {} px a side; {} × {} px is none", most, size_.width,
                            size_.height);
        }
    }

    Size size_;
    std::unique_ptr<Context> context_;
    std::optional<GlyphAtlas> atlas_;
    std::optional<gl::Canvas> canvas_;
    std::optional<gl::Painter> painter_;
    Picture backdrop_, picture_;
    Sketch last_, now_;  // of the last picture; of the one in hand, kept for its memory
    bool first_ = true;
    std::vector<Rect> changed_;
};

Renderer::Renderer(Size size, const DisplayList& backdrop, Gl gl)
    : machine_(std::make_unique<Machine>(size, backdrop, gl)) {}
Renderer::~Renderer() = default;
const Picture& Renderer::draw(const DisplayList& list) {
    return machine_->draw(list);
}
const std::vector<Rect>& Renderer::changed() const {
    return machine_->changed();
}
std::string Renderer::description() const {
    return machine_->description();
}

}  // namespace doppel

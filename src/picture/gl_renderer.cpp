#include "numeric/error.hpp"
#include "picture/damage.hpp"
#include "picture/gl_painter.hpp"
#include "picture/renderer.hpp"

#include <optional>

namespace doppel {

/// What the renderer is made of: a context, two canvases, and the sketch of the last picture.
class Renderer::Machine {
public:
    Machine(Size size, const DisplayList& backdrop) : size_(size), context_(make_osmesa_context()) {
        context_->make_current();
        gl::load(*context_);
        check_size();
        atlas_.emplace(limit(GL_MAX_TEXTURE_SIZE));
        backdrop_.emplace(size);
        canvas_.emplace(size);
        painter_.emplace(size);
        picture_ = Picture(size);
        gl::PixelStorei(GL_PACK_ROW_LENGTH, size.width);

        gl::BindFramebuffer(GL_FRAMEBUFFER, *backdrop_);
        gl::ClearColor(0, 0, 0, 1);
        gl::Clear(GL_COLOR_BUFFER_BIT);
        painter_->load(sketch(backdrop, size, *atlas_), {whole()}, *atlas_);
        painter_->paint(0, whole());
        gl::BindFramebuffer(GL_READ_FRAMEBUFFER, *backdrop_);
        gl::BindFramebuffer(GL_DRAW_FRAMEBUFFER, *canvas_);
    }

    ~Machine() { context_->make_current(); }
    Machine(const Machine&) = delete;
    Machine& operator=(const Machine&) = delete;

    const Picture& draw(const DisplayList& list) {
        context_->make_current();
        Sketch now = sketch(list, size_, *atlas_);
        changed_ = first_ ? std::vector{whole()} : damage(last_, now);
        first_ = false;
        last_ = std::move(now);
        painter_->load(last_, changed_, *atlas_);

        gl::BindFramebuffer(GL_READ_FRAMEBUFFER, *backdrop_);
        for (std::size_t place = 0; place < changed_.size(); ++place) {
            const Rect& r = changed_[place];
            gl::BlitFramebuffer(r.left, r.top, r.right, r.bottom, r.left, r.top, r.right, r.bottom, GL_COLOR_BUFFER_BIT,
                                GL_NEAREST);
            painter_->paint(place, r);
        }
        gl::BindFramebuffer(GL_READ_FRAMEBUFFER, *canvas_);
        for (const Rect& r : changed_) {
            gl::ReadPixels(r.left, r.top, r.right - r.left, r.bottom - r.top, GL_RGBA, GL_UNSIGNED_BYTE,
                           picture_.at(r.left, r.top));
        }
        return picture_;
    }

    const std::vector<Rect>& changed() const { return changed_; }

    std::string description() const {
        context_->make_current();
        const auto text = [](GLenum name) { return reinterpret_cast<const char*>(gl::GetString(name)); };
        return fmt::format("{}, OpenGL {}", text(GL_RENDERER), text(GL_VERSION));
    }

private:
    Rect whole() const { return {0, 0, size_.width, size_.height}; }

    static int limit(GLenum name) {
        GLint value = 0;
        gl::GetIntegerv(name, &value);
        return value;
    }

    void check_size() const {
        const int most = limit(GL_MAX_RENDERBUFFER_SIZE);
        if (size_.width < 1 || size_.height < 1 || size_.width > most || size_.height > most) {
            throw io_failed("OpenGL draws pictures of 1 to {} px a side; {} × {} px is none", most, size_.width,
                            size_.height);
        }
    }

    Size size_;
    std::unique_ptr<Context> context_;
    std::optional<GlyphAtlas> atlas_;
    std::optional<gl::Canvas> backdrop_, canvas_;
    std::optional<gl::Painter> painter_;
    Picture picture_;
    Sketch last_;
    bool first_ = true;
    std::vector<Rect> changed_;
};

Renderer::Renderer(Size size, const DisplayList& backdrop) : machine_(std::make_unique<Machine>(size, backdrop)) {}
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

#include "picture/gl_painter.hpp"

#include "numeric/error.hpp"

#include <algorithm>
#include <cstddef>

namespace doppel::gl {
namespace {

constexpr std::size_t most_quads = 16384;  // of one call: what 16-bit indices reach
constexpr const char* inputs[4] = {"at", "local_at", "shape_of", "tint_of"};

/// The texture that is bound shows its texels as they are.
void set_crisp() {
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

}  // namespace

Painter::Painter(Size size)
    : programs_{Program("quad.vert", "shape.frag", inputs), Program("quad.vert", "glyph.frag", inputs),
                Program("quad.vert", "mask.frag", inputs), Program("quad.vert", "cover.frag", inputs),
                Program("quad.vert", "image.frag", inputs)} {
    // the same for good: pixels from the top left, and the corners of each quad make two triangles
    for (const Program& program : programs_) {
        UseProgram(program);
        Uniform2f(GetUniformLocation(program, "picture"), static_cast<float>(size.width),
                  static_cast<float>(size.height));
    }
    Viewport(0, 0, size.width, size.height);
    Enable(GL_BLEND);
    BindVertexArray(vertex_array_);
    std::vector<std::uint16_t> indices;
    for (std::size_t first = 0; first < 4 * most_quads; first += 4) {
        for (const std::size_t corner : {0, 1, 2, 2, 1, 3}) {
            indices.push_back(static_cast<std::uint16_t>(first + corner));
        }
    }
    BindBuffer(GL_ELEMENT_ARRAY_BUFFER, index_buffer_);
    BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint16_t)), indices.data(),
               GL_STATIC_DRAW);

    BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    const auto input = [](GLuint location, GLint count, GLenum type, std::size_t offset) {
        EnableVertexAttribArray(location);
        VertexAttribPointer(location, count, type, GL_TRUE, sizeof(Vertex), reinterpret_cast<const void*>(offset));
    };
    input(0, 2, GL_FLOAT, offsetof(Vertex, at));
    input(1, 2, GL_FLOAT, offsetof(Vertex, local));
    input(2, 4, GL_FLOAT, offsetof(Vertex, shape));
    input(3, 4, GL_UNSIGNED_BYTE, offsetof(Vertex, tint));

    BindTexture(GL_TEXTURE_2D, atlas_);
    set_crisp();
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

void Painter::load(const Sketch& sketch, const std::vector<Rect>& places, const GlyphAtlas& atlas) {
    vertices_.clear();
    runs_.clear();
    for (std::size_t place = 0; place < places.size(); ++place) {
        for (const Sketch::Part& part : sketch.parts) {
            const std::size_t begin = vertices_.size() / 4;
            for (std::size_t i = part.begin; i < part.end; ++i) {
                if (!common(sketch.bounds[i], places[place]).empty()) add(sketch.quads[i]);
            }
            const std::size_t end = vertices_.size() / 4;
            if (end == begin) continue;
            const Picture* image = sketch.quads[part.begin].image;
            if (!runs_.empty() && runs_.back().place == place && runs_.back().kind == part.kind &&
                runs_.back().image == image) {
                runs_.back().end = end;
            } else {
                runs_.push_back({place, part.kind, begin, end, image});
            }
        }
    }
    upload(atlas);
    upload(sketch.images);
}

void Painter::add(const Quad& quad) {
    for (const float y : {-quad.half.y, quad.half.y}) {
        for (const float x : {-quad.half.x, quad.half.x}) {
            const Point at{quad.center.x + x * quad.axis.x - y * quad.axis.y,
                           quad.center.y + x * quad.axis.y + y * quad.axis.x};
            vertices_.push_back({at, {x, y}, quad.shape, quad.tint});
        }
    }
}

void Painter::upload(const GlyphAtlas& atlas) {
    BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
               GL_STREAM_DRAW);
    if (atlas.count() != atlas_glyphs_) {
        BindTexture(GL_TEXTURE_2D, atlas_);
        TexImage2D(GL_TEXTURE_2D, 0, GL_R8, GlyphAtlas::width, atlas.height(), 0, GL_RED, GL_UNSIGNED_BYTE,
                   atlas.values().data());
        atlas_glyphs_ = atlas.count();
    }
}

void Painter::upload(const std::vector<std::shared_ptr<const Picture>>& images) {
    std::erase_if(images_, [&](const Loaded& loaded) {
        return std::find(images.begin(), images.end(), loaded.pixels) == images.end();
    });
    GLint most = 0;
    GetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    for (const auto& pixels : images) {
        const auto is_it = [&](const Loaded& loaded) { return loaded.pixels == pixels; };
        if (std::any_of(images_.begin(), images_.end(), is_it)) continue;
        const Size size = pixels->size;
        if (size.width > most || size.height > most) {
            throw io_failed("OpenGL takes images of up to {} px a side; {} × {} px is too large", most, size.width,
                            size.height);
        }
        images_.push_back({pixels, std::make_unique<Texture>()});
        BindTexture(GL_TEXTURE_2D, *images_.back().texture);
        set_crisp();
        TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   pixels->rgba.data());
    }
}

void Painter::use(const Run& run) const {
    UseProgram(programs_[static_cast<std::size_t>(run.kind)]);
    BlendEquation(run.kind == Kind::mask ? GL_MIN : GL_FUNC_ADD);
    const GLboolean color = run.kind != Kind::mask, alpha = run.kind == Kind::mask || run.kind == Kind::cover;
    ColorMask(color, color, color, alpha);
    if (run.kind == Kind::cover) {
        BlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_DST_ALPHA, GL_ONE, GL_ZERO);
    } else {
        BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    if (run.kind == Kind::glyph) BindTexture(GL_TEXTURE_2D, atlas_);
    for (const Loaded& loaded : images_) {
        if (loaded.pixels.get() == run.image) BindTexture(GL_TEXTURE_2D, *loaded.texture);
    }
}

void Painter::paint(std::size_t place, const Rect& within) const {
    Enable(GL_SCISSOR_TEST);
    Scissor(within.left, within.top, within.right - within.left, within.bottom - within.top);
    for (const Run& run : runs_) {
        if (run.place != place) continue;
        use(run);
        for (std::size_t begin = run.begin; begin < run.end; begin += most_quads) {
            const std::size_t count = std::min(run.end - begin, most_quads);
            DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(6 * count), GL_UNSIGNED_SHORT, nullptr,
                                   static_cast<GLint>(4 * begin));
        }
    }
    Disable(GL_SCISSOR_TEST);
}

}  // namespace doppel::gl

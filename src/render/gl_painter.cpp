#include "render/gl_painter.hpp"

#include "base/error.hpp"
#include "embedded/render.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace doppel::gl {
namespace {

constexpr GLboolean on = GL_TRUE, off = GL_FALSE;

void attach(GLuint program, GLenum type, const std::string& name) {
    const std::string_view source = embedded_file(render_files(), name);
    const char* text = source.data();
    const auto length = static_cast<GLint>(source.size());
    const GLuint shader = CreateShader(type);
    ShaderSource(shader, 1, &text, &length);
    CompileShader(shader);
    AttachShader(program, shader);
    DeleteShader(shader);
    GLint compiled = GL_FALSE;
    GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    std::string log(1024, '\0');
    GetShaderInfoLog(shader, 1024, nullptr, log.data());
    if (!compiled) throw io_failed("shaders/{}: {}", name, log.c_str());
}

/// shaders/quad.vert, whose inputs have the locations 0 to 5 in their order there, and a fragment shader.
GLuint program_of(const std::string& fragment) {
    const GLuint program = CreateProgram();
    attach(program, GL_VERTEX_SHADER, "quad.vert");
    attach(program, GL_FRAGMENT_SHADER, fragment);
    GLuint location = 0;
    for (const char* input :
         {"vertex_position", "vertex_frame", "vertex_shape", "vertex_params", "vertex_parabola", "vertex_tint"})
        BindAttribLocation(program, location++, input);
    LinkProgram(program);
    GLint linked = GL_FALSE;
    GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) throw io_failed("shaders/quad.vert and {} cannot be linked", fragment);
    return program;
}

GLuint object_of(const auto& generate) {
    GLuint number = 0;
    generate(1, &number);
    return number;
}

/// The corners of a rotated primitive, in order.
std::array<Point, 4> outline(const Primitive& primitive) {
    const float room = 0.05f;  // px, so that rounding excludes no pixel
    const Point x{primitive.axis.x * (primitive.half.x + room), primitive.axis.y * (primitive.half.x + room)};
    const Point y{-primitive.axis.y * (primitive.half.y + room), primitive.axis.x * (primitive.half.y + room)};
    const auto corner = [&](float along, float across) {
        return Point{primitive.origin.x + along * x.x + across * y.x, primitive.origin.y + along * x.y + across * y.y};
    };
    return {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
}

}  // namespace

void check_errors(const std::string& what) {
    const GLenum first = GetError();
    if (first == GL_NO_ERROR) return;
    bool no_memory = false;
    // a driver may store several errors; a lost context returns one for ever
    GLenum error = first;
    for (int k = 0; k < 16 && error != GL_NO_ERROR; ++k, error = GetError()) no_memory |= error == GL_OUT_OF_MEMORY;
    if (no_memory) throw io_failed("OpenGL has no memory for {}", what);
    throw io_failed("OpenGL failed at {}: error {:#06x}", what, first);
}

Painter::Painter(Size size)
    : pixels_(object_of(GenTextures)),
      framebuffer_(object_of(GenFramebuffers)),
      programs_{program_of("shape.frag"), program_of("glyph.frag"), program_of("mask.frag")},
      cover_(program_of("cover.frag")),
      vertex_array_(object_of(GenVertexArrays)),
      vertex_buffer_(object_of(GenBuffers)),
      atlas_(object_of(GenTextures)) {
    // constant state: pixel coordinates from the top left
    for (const GLuint program : {programs_[0], programs_[1], programs_[2], cover_}) {
        UseProgram(program);
        Uniform2f(GetUniformLocation(program, "picture"), static_cast<float>(size.width),
                  static_cast<float>(size.height));
    }
    Viewport(0, 0, size.width, size.height);
    Enable(GL_BLEND);
    BindVertexArray(vertex_array_);
    BindBuffer(GL_ARRAY_BUFFER, vertex_buffer_);
    const auto input = [](GLuint location, GLint count, GLenum type, std::size_t offset) {
        EnableVertexAttribArray(location);
        VertexAttribPointer(location, count, type, on, GLsizei{sizeof(Vertex)}, reinterpret_cast<const void*>(offset));
    };
    input(0, 2, GL_FLOAT, offsetof(Vertex, at));
    input(1, 4, GL_FLOAT, offsetof(Vertex, of) + offsetof(Primitive, origin));
    input(2, 4, GL_FLOAT, offsetof(Vertex, of) + offsetof(Primitive, shape));
    input(3, 4, GL_FLOAT, offsetof(Vertex, of) + offsetof(Primitive, params));
    input(4, 2, GL_FLOAT, offsetof(Vertex, of) + offsetof(Primitive, parabola));
    input(5, 4, GL_UNSIGNED_BYTE, offsetof(Vertex, of) + offsetof(Primitive, tint));

    BindTexture(GL_TEXTURE_2D, atlas_);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    check_errors("the shaders and the buffers of their input");

    const auto canvas = fmt::format("a picture of {} × {} px", size.width, size.height);
    BindTexture(GL_TEXTURE_2D, pixels_);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    BindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, pixels_, 0);
    check_errors(canvas);
    if (CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw io_failed("OpenGL has no memory for {}", canvas);
}

void Painter::put(const Picture& picture, const Rect& r) {
    BindTexture(GL_TEXTURE_2D, pixels_);
    TexSubImage2D(GL_TEXTURE_2D, 0, r.left, r.top, r.right - r.left, r.bottom - r.top, GL_RGBA, GL_UNSIGNED_BYTE,
                  picture.at(r.left, r.top));
}

void Painter::paint(const RenderList& items, const std::vector<Rect>& regions, const GlyphAtlas& atlas) {
    auto batches = batches_of(items, regions);
    vertices_.clear();
    for (Batch& batch : batches) {
        batch.begin = vertices_.size();
        for (const std::size_t p : batch.parts)
            for (std::size_t i = items.parts[p].begin; i < items.parts[p].end; ++i) add(items.primitives[i], regions);
        batch.end = vertices_.size();
    }
    upload_vertices();
    upload(atlas);
    for (const Batch& batch : batches) draw(batch);
}

/// Groups the parts into few batches. A part may be drawn earlier than its turn if it overlaps nothing in between.
std::vector<Painter::Batch> Painter::batches_of(const RenderList& items, const std::vector<Rect>& regions) {
    std::vector<Batch> batches;
    const auto meet = [](const Rect& a, const Rect& b) { return !intersection(a, b).empty(); };
    for (std::size_t p = 0; p < items.parts.size(); ++p) {
        const RenderList::Part& part = items.parts[p];
        if (std::ranges::none_of(regions, [&](const Rect& r) { return meet(r, part.bounds); })) continue;
        std::size_t home = batches.size();
        for (std::size_t r = batches.size(); r-- > 0;) {
            const bool met = meet(batches[r].bounds, part.bounds);
            // the masks of two strokes must not mix
            if (batches[r].kind == part.kind && !(met && part.kind == Kind::mask)) home = r;
            if (met || batches.size() - r > 16) break;
        }
        if (home == batches.size()) batches.push_back({.kind = part.kind});
        batches[home].bounds = united(batches[home].bounds, part.bounds);
        batches[home].parts.push_back(p);
    }
    return batches;
}

/// Adds the part of the primitive inside the regions. Each pixel is drawn once.
void Painter::add(const Primitive& primitive, const std::vector<Rect>& regions) {
    for (const Rect& region : regions) {
        const Rect seen = intersection(primitive.bounds, region);
        if (seen.empty()) continue;
        const auto left = static_cast<float>(seen.left), right = static_cast<float>(seen.right);
        const auto top = static_cast<float>(seen.top), bottom = static_cast<float>(seen.bottom);
        outline_ = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
        if (primitive.half.x > 0) {
            // the rotated outline covers fewer pixels than the bounds
            const auto corners = outline(primitive);
            outline_.assign(corners.begin(), corners.end());
            if (seen != primitive.bounds) clip(left, right, top, bottom);
        }
        for (std::size_t i = 2; i < outline_.size(); ++i)
            for (const std::size_t corner : {std::size_t{0}, i - 1, i})
                vertices_.push_back({outline_[corner], primitive});
    }
}

/// Keeps the part of the convex outline inside (Sutherland & Hodgman 1974). Cuts are exactly at pixel edges.
void Painter::clip(float left, float right, float top, float bottom) {
    const auto cut = [&](float Point::*across, float Point::*along, float edge, float side) {
        clipped_.clear();
        for (std::size_t i = 0; i < outline_.size(); ++i) {
            const Point &from = outline_[i], &to = outline_[(i + 1) % outline_.size()];
            const float before = side * (from.*across - edge), after = side * (to.*across - edge);  // ≥ 0 inside
            if (before >= 0) clipped_.push_back(from);
            if ((before >= 0) == (after >= 0)) continue;
            Point at;
            at.*across = edge;
            at.*along = from.*along + (to.*along - from.*along) * (before / (before - after));
            clipped_.push_back(at);
        }
        std::swap(outline_, clipped_);
    };
    cut(&Point::x, &Point::y, left, 1);
    cut(&Point::x, &Point::y, right, -1);
    cut(&Point::y, &Point::x, top, 1);
    cut(&Point::y, &Point::x, bottom, -1);
}

void Painter::upload_vertices() {
    const std::size_t needed = vertices_.size() * sizeof(Vertex);
    if (needed > vertex_room_) {
        vertex_room_ = needed + needed / 2;
        BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_room_), nullptr, GL_DYNAMIC_DRAW);
        check_errors(fmt::format("the outlines of {} shapes", vertices_.size() / 6));
    }
    BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(needed), vertices_.data());
}

void Painter::upload(const GlyphAtlas& atlas) {
    if (atlas.count() == atlas_glyphs_) return;
    PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    BindTexture(GL_TEXTURE_2D, atlas_);
    TexImage2D(GL_TEXTURE_2D, 0, GL_R8, GlyphAtlas::width, atlas.height(), 0, GL_RED, GL_UNSIGNED_BYTE,
               atlas.values().data());
    check_errors(fmt::format("an atlas of {} glyphs", atlas.count()));
    atlas_glyphs_ = atlas.count();
}

void Painter::draw(const Batch& batch) {
    const auto draw_triangles = [&](GLuint program) {
        UseProgram(program);
        DrawArrays(GL_TRIANGLES, static_cast<GLint>(batch.begin), static_cast<GLsizei>(batch.end - batch.begin));
    };
    if (batch.kind == Kind::glyph) BindTexture(GL_TEXTURE_2D, atlas_);
    if (batch.kind == Kind::mask) {
        BlendEquation(GL_MIN);
        ColorMask(off, off, off, on);
        draw_triangles(programs_[static_cast<std::size_t>(batch.kind)]);
        BlendEquation(GL_FUNC_ADD);
        ColorMask(on, on, on, on);
        BlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_DST_ALPHA, GL_ONE, GL_ZERO);
        draw_triangles(cover_);
    } else {
        BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        draw_triangles(programs_[static_cast<std::size_t>(batch.kind)]);
    }
}

}  // namespace doppel::gl

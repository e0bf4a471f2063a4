#include "picture/gl_painter.hpp"

#include "numeric/error.hpp"

#include <algorithm>
#include <cstddef>

namespace doppel::gl {
namespace {

constexpr std::size_t most_quads = 16384;  // of one call: what 16-bit indices reach
constexpr const char* inputs[5] = {"at", "place_of", "shape_of", "more_of", "tint_of"};

/// The texture that is bound shows its texels as they are.
void set_crisp() {
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

}  // namespace

Painter::Painter(Size size)
    : programs_{Program("quad.vert", "shape.frag", inputs), Program("quad.vert", "glyph.frag", inputs),
                Program("quad.vert", "mask.frag", inputs), Program("quad.vert", "image.frag", inputs)},
      cover_("quad.vert", "cover.frag", inputs) {
    // the same for good: pixels from the top left, and the corners of each quad make two triangles
    for (const Program* program : {&programs_[0], &programs_[1], &programs_[2], &programs_[3], &cover_}) {
        UseProgram(*program);
        Uniform2f(GetUniformLocation(*program, "picture"), static_cast<float>(size.width),
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
    input(1, 4, GL_FLOAT, offsetof(Vertex, origin));
    input(2, 4, GL_FLOAT, offsetof(Vertex, shape));
    input(3, 4, GL_FLOAT, offsetof(Vertex, more));
    input(4, 4, GL_UNSIGNED_BYTE, offsetof(Vertex, tint));

    BindTexture(GL_TEXTURE_2D, atlas_);
    set_crisp();
    PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

void Painter::paint(const Sketch& sketch, const std::vector<Rect>& places, const GlyphAtlas& atlas) {
    plan(sketch, places);
    vertices_.clear();
    for (std::size_t r = 0; r < used_runs_; ++r) {
        Run& run = runs_[r];
        run.begin = vertices_.size() / 4;
        for (const std::size_t p : run.parts) {
            for (std::size_t i = sketch.parts[p].begin; i < sketch.parts[p].end; ++i) {
                add(sketch.quads[i], sketch.bounds[i], places);
            }
        }
        run.end = vertices_.size() / 4;
    }
    upload_vertices();
    upload(atlas);
    upload(sketch.images);
    for (std::size_t r = 0; r < used_runs_; ++r) draw(runs_[r]);
}

/// Shares out the parts among few runs. A part may be drawn earlier than its turn if it meets nothing on the way.
void Painter::plan(const Sketch& sketch, const std::vector<Rect>& places) {
    used_runs_ = 0;
    const auto meet = [](const Rect& a, const Rect& b) { return !common(a, b).empty(); };
    for (std::size_t p = 0; p < sketch.parts.size(); ++p) {
        const Sketch::Part& part = sketch.parts[p];
        if (std::none_of(places.begin(), places.end(), [&](const Rect& r) { return meet(r, part.bounds); })) continue;
        const Picture* image = sketch.quads[part.begin].image;
        std::size_t home = used_runs_;
        for (std::size_t r = used_runs_; r-- > 0;) {
            const bool met = meet(runs_[r].bounds, part.bounds);
            // the masks of two strokes must not mix
            if (runs_[r].kind == part.kind && runs_[r].image == image && !(met && part.kind == Kind::mask)) home = r;
            if (met || used_runs_ - r > 16) break;
        }
        if (home == used_runs_) {
            if (++used_runs_ > runs_.size()) runs_.emplace_back();
            runs_[home].kind = part.kind;
            runs_[home].image = image;
            runs_[home].bounds = {};
            runs_[home].parts.clear();
        }
        runs_[home].bounds = united(runs_[home].bounds, part.bounds);
        runs_[home].parts.push_back(p);
    }
}

/// What of the quad lies within the places. A pixel that it touches is drawn once, whichever way.
void Painter::add(const Quad& quad, const Rect& bounds, const std::vector<Rect>& places) {
    for (const Rect& place : places) {
        const Rect seen = common(bounds, place);
        if (seen.empty()) continue;
        if (seen == bounds && quad.half.x > 0) return add_turned(quad);
        for_each_band(quad, seen, [&](const Rect& part) { add(quad, part); });
    }
}

void Painter::add(const Quad& quad, const Rect& part) {
    const auto left = static_cast<float>(part.left), right = static_cast<float>(part.right);
    const auto top = static_cast<float>(part.top), bottom = static_cast<float>(part.bottom);
    for (const Point at : {Point{left, top}, Point{right, top}, Point{left, bottom}, Point{right, bottom}})
        add(quad, at);
}

/// Along its own axes, where fewer pixels lie around what it shows.
void Painter::add_turned(const Quad& quad) {
    const float room = 0.05f;  // px, so that rounding loses none
    const Point half{quad.half.x + room, quad.half.y + room};
    for (const float y : {-half.y, half.y}) {
        for (const float x : {-half.x, half.x}) {
            add(quad, Point{quad.origin.x + x * quad.axis.x - y * quad.axis.y,
                            quad.origin.y + x * quad.axis.y + y * quad.axis.x});
        }
    }
}

void Painter::add(const Quad& quad, Point at) {
    vertices_.push_back({at, quad.origin, quad.axis, quad.shape, quad.more, quad.tint});
}

void Painter::upload_vertices() {
    const std::size_t needed = vertices_.size() * sizeof(Vertex);
    if (needed > vertex_room_) {
        vertex_room_ = needed + needed / 2;
        BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertex_room_), nullptr, GL_DYNAMIC_DRAW);
    }
    BufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(needed), vertices_.data());
}

void Painter::upload(const GlyphAtlas& atlas) {
    if (atlas.count() == atlas_glyphs_) return;
    PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    BindTexture(GL_TEXTURE_2D, atlas_);
    TexImage2D(GL_TEXTURE_2D, 0, GL_R8, GlyphAtlas::width, atlas.height(), 0, GL_RED, GL_UNSIGNED_BYTE,
               atlas.values().data());
    atlas_glyphs_ = atlas.count();
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
        PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        images_.push_back({pixels, std::make_unique<Texture>()});
        BindTexture(GL_TEXTURE_2D, *images_.back().texture);
        set_crisp();
        TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.width, size.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   pixels->rgba.data());
    }
}

void Painter::draw(const Run& run) {
    const auto draw_quads = [&](const Program& program) {
        UseProgram(program);
        for (std::size_t begin = run.begin; begin < run.end; begin += most_quads) {
            const std::size_t count = std::min(run.end - begin, most_quads);
            DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(6 * count), GL_UNSIGNED_SHORT, nullptr,
                                   static_cast<GLint>(4 * begin));
        }
    };
    if (run.kind == Kind::glyph) BindTexture(GL_TEXTURE_2D, atlas_);
    for (const Loaded& loaded : images_) {
        if (loaded.pixels.get() == run.image) BindTexture(GL_TEXTURE_2D, *loaded.texture);
    }
    if (run.kind == Kind::mask) {
        BlendEquation(GL_MIN);
        ColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
        draw_quads(programs_[static_cast<std::size_t>(run.kind)]);
        BlendEquation(GL_FUNC_ADD);
        ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        BlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_DST_ALPHA, GL_ONE, GL_ZERO);
        draw_quads(cover_);
    } else {
        BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
        draw_quads(programs_[static_cast<std::size_t>(run.kind)]);
    }
}

}  // namespace doppel::gl

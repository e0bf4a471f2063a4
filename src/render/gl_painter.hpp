#pragma once

#include "render/gl_context.hpp"
#include "render/render_list.hpp"

#include <string>

namespace doppel::gl {

/// Throws Error (exit 4) if OpenGL has reported an error since the last call. `what`: the task.
void check_errors(const std::string& what);

/// A canvas of RGBA pixels, all zero at first, and what draws render lists onto it. Row 0 is the top of the picture. A
/// stroke takes two passes. The first writes 1 - opacity of each segment into the canvas's alpha, which is 1 otherwise.
/// The minimum is kept, so that overlapping segments do not add up. The second blends the colour by alpha and restores
/// alpha 1, so that drawing a pixel twice changes nothing. Its OpenGL objects end with the context.
class Painter {
public:
    /// Binds the canvas. Throws Error if memory is exhausted.
    explicit Painter(Size size);

    /// Copies the picture's pixels within `r` to the canvas. The unpack row length must be the picture's width.
    void put(const Picture& picture, const Rect& r);
    /// Draws the render list inside `regions`, which must not overlap.
    void paint(const RenderList& items, const std::vector<Rect>& regions, const GlyphAtlas& atlas);

private:
    struct Vertex {
        Point at;
        Primitive of;
    };
    struct Batch {
        Kind kind;
        Rect bounds{};                   // union of its parts' bounds
        std::size_t begin = 0, end = 0;  // in vertices
        std::vector<std::size_t> parts{};
    };

    static std::vector<Batch> batches_of(const RenderList& items, const std::vector<Rect>& regions);
    void add(const Primitive& primitive, const std::vector<Rect>& regions);
    void clip(float left, float right, float top, float bottom);
    void upload_vertices();
    void upload(const GlyphAtlas& atlas);
    void draw(const Batch& batch);

    const GLuint pixels_, framebuffer_;     // of the canvas
    const std::array<GLuint, 3> programs_;  // for each Kind
    const GLuint cover_, vertex_array_, vertex_buffer_, atlas_;
    std::size_t vertex_room_ = 0;  // size of the buffer, bytes
    std::size_t atlas_glyphs_ = 0;
    std::vector<Vertex> vertices_;
    std::vector<Point> outline_, clipped_;  // of the primitive being added
};

}  // namespace doppel::gl

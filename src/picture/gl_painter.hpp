#pragma once

#include "picture/gl_objects.hpp"
#include "picture/sketch.hpp"

#include <cstdint>

namespace doppel::gl {

/// Draws sketches onto the canvas that is bound.
///
/// A canvas's alpha is 1 at rest. While a stroke is drawn it holds how transparent the stroke is there: segments keep
/// the smallest value, so that they do not add up where they meet; then the cover blends the colour and restores the 1.
class Painter {
public:
    explicit Painter(Size size);

    /// Takes what of the sketch touches each of the `places`, and glyphs and images that are new. Throws Error where an
    /// image is larger than OpenGL takes.
    void load(const Sketch& sketch, const std::vector<Rect>& places, const GlyphAtlas& atlas);
    /// Draws what was loaded for places[place], cut off at its edges.
    void paint(std::size_t place, const Rect& within) const;

private:
    struct Vertex {
        Point at, local;
        std::array<float, 4> shape;
        std::array<std::uint8_t, 4> tint;
    };
    /// Quads drawn by one call.
    struct Run {
        std::size_t place;
        Kind kind;
        std::size_t begin, end;
        const Picture* image;
    };
    /// An image among OpenGL's textures.
    struct Loaded {
        std::shared_ptr<const Picture> pixels;
        std::unique_ptr<Texture> texture;
    };

    void add(const Quad& quad);
    void upload(const GlyphAtlas& atlas);
    void upload(const std::vector<std::shared_ptr<const Picture>>& images);
    void use(const Run& run) const;

    std::array<Program, 5> programs_;  // by kind
    VertexArray vertex_array_;
    Buffer vertex_buffer_, index_buffer_;
    Texture atlas_;
    std::size_t atlas_glyphs_ = 0;
    std::vector<Loaded> images_;
    std::vector<Vertex> vertices_;
    std::vector<Run> runs_;
};

}  // namespace doppel::gl

#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"
#include "render/render_list.hpp"
#include "render/typeface.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// Which OpenGL draws; no display or GPU is required. Their pixels agree within the golden policy.
enum class Gl {
    automatic,  // OSMesa, or EGL if OSMesa does not work
    osmesa,     // Mesa's software renderer, into memory
    egl,        // EGL without a surface: on a GPU if there is one, otherwise by Mesa in software
};

class Context;
namespace gl {
class Painter;
}

/// Draws display lists into pictures of one size: a fixed backdrop with a list on top. Only the rectangles in which the
/// list differs from the last one are drawn and read back; the pixels are the same as if everything had been drawn.
class Renderer {
public:
    /// `typeface`: the fonts of all text. Throws Error: exit 4 if there is no such OpenGL context or no memory for this
    /// size, exit 130 as draw().
    explicit Renderer(Size size, const DisplayList& backdrop = {}, Gl gl = Gl::automatic,
                      const std::atomic<bool>& stop = false, const Typeface& typeface = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// The backdrop with `list` on top, valid until the next draw(). Throws Error: exit 4 if OpenGL fails, exit 130
    /// soon after `stop` is set.
    const Picture& draw(const DisplayList& list, const std::atomic<bool>& stop = false);

    /// Where the last picture differs from the previous one; after the first draw(), everywhere.
    const std::vector<Rect>& changed() const { return changed_; }

    /// The library and driver for the manifest: "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 3.3 Mesa 22.3.6".
    std::string description() const;

private:
    /// Draws the current render list inside `regions`, and reads the pixels back.
    void paint(const std::vector<Rect>& regions, Picture& into);

    Size size_;
    std::unique_ptr<Context> context_;
    std::optional<GlyphAtlas> atlas_;
    std::unique_ptr<gl::Painter> painter_;
    Picture backdrop_, picture_;
    RenderList last_, now_;  // of the last picture; of the current one
    bool first_ = true;
    std::vector<Rect> changed_;
};

}  // namespace doppel

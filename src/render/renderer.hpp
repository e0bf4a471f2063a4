#pragma once

#include "image/picture.hpp"
#include "render/display_list.hpp"
#include "render/typeface.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// Whose OpenGL draws; neither wants a display or a GPU. The pixels are the same by the golden policy.
enum class Gl {
    automatic,  // OSMesa, or EGL where OSMesa does not work
    osmesa,     // Mesa drawing in software, into memory
    egl,        // EGL without a surface: a GPU where there is one, otherwise Mesa in software
};

/// What people call them: "auto", "osmesa", "egl".
std::vector<std::string> gl_names();

/// Throws Error (exit 2) where nothing is called so.
Gl gl_named(const std::string& name);

/// Draws display lists into pictures of one size, without a display (OSMesa or EGL).
///
/// A picture is a fixed backdrop with a new list on top. Only the rectangles where the list differs from the last one
/// are drawn and read back; the pixels are the same as if everything had been drawn.
class Renderer {
public:
    /// Text is drawn in `typeface`. Throws Error: exit 4 where no OpenGL context of this kind or no memory for this size
    /// is to be had, 130 as draw().
    explicit Renderer(Size size, const DisplayList& backdrop = {}, Gl gl = Gl::automatic,
                      const std::atomic<bool>& stop = false, const Typeface& typeface = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// The backdrop with `list` on top, valid until the next draw(). Throws Error: exit 4 where OpenGL fails, exit 130
    /// soon after `stop` is set.
    const Picture& draw(const DisplayList& list, const std::atomic<bool>& stop = false);

    /// Where the last picture differs from the one before it; the whole picture after the first draw().
    const std::vector<Rect>& changed() const;

    /// What draws, for the manifest: "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 3.3 Mesa 22.3.6".
    std::string description() const;

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace doppel

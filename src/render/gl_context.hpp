#pragma once

#include "render/gl_api.hpp"
#include "render/renderer.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace doppel {

/// An OpenGL 3.3 core context without a window. It must be used and destroyed in the thread that made it. Contexts of
/// different libraries may be used in one thread.
class Context {
public:
    /// A context of a library, and the library's functions for it.
    struct Functions {
        const char* library;  // "OSMesa" or "EGL"
        std::function<void()> bind, release, destroy;
        std::function<gl::Function(const char* name)> find;
    };
    explicit Context(Functions functions) : own_(std::move(functions)) {}
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current in this thread; cheap if it already is. Throws Error on failure.
    void make_current();
    std::string library() const { return own_.library; }

private:
    /// If this context is current, makes none current.
    void retire();

    Functions own_;
    std::optional<gl::Functions> opengl_;  // loaded when the context is first made current
};

/// Names under which the dynamic linker may find the libraries, in order.
struct GlLibraries {
    std::vector<std::string> osmesa{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    std::vector<std::string> egl{"libEGL.so.1", "libEGL.so"};
};

/// Makes a context and makes it current. Throws Error (exit 4) if none of the allowed libraries works: why each failed,
/// and which packages contain them.
std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries = {});

}  // namespace doppel

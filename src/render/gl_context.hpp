#pragma once

#include "render/gl_api.hpp"
#include "render/renderer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// An OpenGL 3.3 core context without a window, to be used and destroyed in the thread that made it. Contexts of
/// different libraries may share a thread.
class Context {
public:
    Context() = default;
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes OpenGL's calls of this thread go here; cheap where they already do. Throws Error where it fails.
    void make_current();
    /// Whose context it is: "OSMesa", "EGL".
    virtual std::string library() const = 0;

protected:
    /// If this context is current, none is afterwards. Destructors of derived classes call it first.
    void retire();

private:
    virtual void bind() = 0;
    virtual void release() = 0;
    virtual gl::Function function(const char* name) const = 0;

    gl::Functions functions_;  // found when first bound
    bool loaded_ = false;
};

/// Where the libraries may be found, in order; names for the dynamic linker.
struct GlLibraries {
    std::vector<std::string> osmesa{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    std::vector<std::string> egl{"libEGL.so.1", "libEGL.so"};
};

/// A context, made current. Throws Error (exit 4) where what was asked for cannot draw: which libraries were tried, why
/// each failed and which packages have them.
std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries = {});

}  // namespace doppel

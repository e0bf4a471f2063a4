#pragma once

#include "render/gl_api.hpp"
#include "render/renderer.hpp"

#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// An OpenGL 3.3 core context without a window. It must be used and destroyed in the thread that made it. Contexts of
/// different libraries may be used in one thread.
class Context {
public:
    Context() = default;
    virtual ~Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    /// Makes this context current in this thread; cheap if it already is. Throws Error on failure.
    void make_current();
    /// The library: "OSMesa" or "EGL".
    virtual std::string library() const = 0;

protected:
    /// If this context is current, makes none current. Destructors of derived classes call it first.
    void retire();

private:
    virtual void bind() = 0;
    virtual void release() = 0;
    virtual gl::Function function(const char* name) const = 0;

    gl::Functions functions_;  // loaded when the context is first made current
    bool loaded_ = false;
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

#pragma once

#include "render/gl.hpp"
#include "render/gl_api.hpp"

#include <memory>
#include <string>
#include <vector>

namespace doppel {

/// An OpenGL 3.3 core context without a window, to be used and destroyed in the thread that made it. Contexts of
/// different libraries may share a thread.
class Context {
public:
    virtual ~Context() = default;
    /// Makes OpenGL's calls of this thread go here; cheap where they already do. Throws Error where it fails.
    void make_current();
    /// Whose context it is: "OSMesa", "EGL".
    virtual std::string library() const = 0;

protected:
    /// For the destructors of those below, first of all: this thread's calls go nowhere if they went here.
    void retire();

private:
    virtual void bind() = 0;
    virtual void release() = 0;
    virtual gl::Function function(const char* name) const = 0;

    gl::Functions functions_;  // of OpenGL, as this library has them; found when first bound
    bool loaded_ = false;
};

/// Where the libraries may be found, in order; names for the dynamic linker.
struct GlLibraries {
    std::vector<std::string> osmesa{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    std::vector<std::string> egl{"libEGL.so.1", "libEGL.so"};
};

/// Current. Throws Error (exit 4) where what was asked for cannot draw: which libraries were tried, why each failed and
/// which packages have them.
std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries = {});

/// One library's; not yet current. Throws Error.
std::unique_ptr<Context> make_osmesa_context(const std::vector<std::string>& libraries);
std::unique_ptr<Context> make_egl_context(const std::vector<std::string>& libraries);

}  // namespace doppel

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

/// A shared library found at run time. It stays for the rest of the process: Mesa does not bear being unloaded.
class Library {
public:
    /// The first of `names` that there is. Throws Error (exit 4), which says why none could be loaded.
    explicit Library(const std::vector<std::string>& names);

    /// Sets `function` to the library's function `name`, whose type is the caller's word. Throws Error (exit 4) where
    /// there is none.
    template <class Function>
    void find(const char* name, Function*& function) const {
        function = reinterpret_cast<Function*>(address(name));
    }

private:
    void* address(const char* name) const;

    std::string name_;
    void* handle_ = nullptr;
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

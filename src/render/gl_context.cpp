#include "render/gl_context.hpp"

#include "base/error.hpp"

#include <cstdlib>

namespace doppel {
namespace {

// OpenGL's own notion of what is current, which belongs to the thread
constinit thread_local Context* current = nullptr;

/// Settings that Mesa reads from the environment, where the user has set none.
bool tell_mesa() {
    // the threads of the machine have better work than sharing one small picture
    setenv("LP_NUM_THREADS", "0", 0);
    // what EGL says of the drivers that it tries in vain is not for those who want a picture
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return true;
}

/// A library and what to do where it fails.
struct Way {
    const char* name;
    const char* packages;  // of Debian and Ubuntu
    std::unique_ptr<Context> (*make)(const std::vector<std::string>& libraries);
    const std::vector<std::string>& libraries;
};

std::unique_ptr<Context> try_way(const Way& way, std::string& faults) {
    try {
        auto context = way.make(way.libraries);
        context->make_current();
        return context;
    } catch (const Error& fault) {
        faults += fmt::format("{}{} cannot draw here: {} (in Debian: {})", faults.empty() ? "" : "; ", way.name,
                              fault.what(), way.packages);
        return nullptr;
    }
}

}  // namespace

void Context::make_current() {
    if (current == this) return;
    // the libraries do not know of each other: the one must let go before the other takes hold
    if (current) current->retire();
    bind();
    current = this;
    if (!loaded_) functions_ = gl::load([this](const char* name) { return function(name); });
    loaded_ = true;
    gl::current = &functions_;
}

void Context::retire() {
    if (current != this) return;
    release();
    current = nullptr;
    gl::current = nullptr;
}

std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries) {
    [[maybe_unused]] static const bool told = tell_mesa();  // once, for environments are nothing that threads may share
    const Way osmesa{"OSMesa", "libosmesa6", make_osmesa_context, libraries.osmesa},
        egl{"EGL", "libegl1, libegl-mesa0, libgl1-mesa-dri", make_egl_context, libraries.egl};
    std::string faults;
    std::unique_ptr<Context> context;
    if (gl != Gl::egl) context = try_way(osmesa, faults);
    if (!context && gl != Gl::osmesa) context = try_way(egl, faults);
    if (!context) throw Error(ExitCode::io_failed, faults);
    return context;
}

}  // namespace doppel

#include "render/gl_context.hpp"

#include "base/error.hpp"

#include <dlfcn.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace doppel::gl {

constinit thread_local const Functions* current = nullptr;

Functions load(const std::function<Function(const char* name)>& find) {
    const auto found = [&](const char* name) {
        const Function function = find(name);
        if (!function) throw io_failed("its OpenGL has no {}", name);
        return function;
    };
    Functions functions;
#define X(type, name) functions.name = reinterpret_cast<type>(found("gl" #name));
    DOPPEL_GL_FUNCTIONS(X)
#undef X
    return functions;
}

}  // namespace doppel::gl

namespace doppel {
namespace {

constexpr std::array<std::pair<const char*, Gl>, 3> names{
    {{"auto", Gl::automatic}, {"osmesa", Gl::osmesa}, {"egl", Gl::egl}}};

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

/// A library that makes contexts, and what to tell where it fails.
struct ContextLibrary {
    const char* name;
    const char* packages;  // of Debian and Ubuntu
    std::unique_ptr<Context> (*make)(const std::vector<std::string>& names);
    const std::vector<std::string>& names;
};

std::unique_ptr<Context> try_library(const ContextLibrary& library, std::string& faults) {
    try {
        auto context = library.make(library.names);
        context->make_current();
        return context;
    } catch (const Error& fault) {
        faults += fmt::format("{}{} cannot draw here: {} (in Debian: {})", faults.empty() ? "" : "; ", library.name,
                              fault.what(), library.packages);
        return nullptr;
    }
}

}  // namespace

std::vector<std::string> gl_names() {
    std::vector<std::string> all;
    for (const auto& [name, gl] : names) all.emplace_back(name);
    return all;
}

Gl gl_named(const std::string& name) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& known) { return known.first == name; });
    if (found == names.end())
        throw bad_input("nothing that draws is called \"{}\"; there are {}", name, fmt::join(gl_names(), ", "));
    return found->second;
}

Library::Library(const std::vector<std::string>& names) {
    std::string faults;
    for (const auto& name : names) {
        handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (handle_) {
            name_ = name;
            return;
        }
        // a library that is there and cannot be used says more than one that is not there
        const std::string fault = dlerror();
        if (!fault.starts_with(name + ": cannot open shared object file: No such file"))
            faults += (faults.empty() ? "" : "; ") + fault;
    }
    throw Error(ExitCode::io_failed, faults.empty() ? fmt::format("there is no {}", fmt::join(names, " or ")) : faults);
}

void* Library::address(const char* name) const {
    void* const found = dlsym(handle_, name);
    if (!found) throw io_failed("{} has no {}", name_, name);
    return found;
}

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
    const ContextLibrary osmesa{"OSMesa", "libosmesa6", make_osmesa_context, libraries.osmesa},
        egl{"EGL", "libegl1, libegl-mesa0, libgl1-mesa-dri", make_egl_context, libraries.egl};
    std::string faults;
    std::unique_ptr<Context> context;
    if (gl != Gl::egl) context = try_library(osmesa, faults);
    if (!context && gl != Gl::osmesa) context = try_library(egl, faults);
    if (!context) throw Error(ExitCode::io_failed, faults);
    return context;
}

}  // namespace doppel

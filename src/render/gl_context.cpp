#include "render/gl_context.hpp"

#include "base/error.hpp"
#include "base/shared_library.hpp"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <array>
#include <cstdlib>

namespace doppel {

constinit thread_local const gl::Functions* gl::current = nullptr;

namespace {

gl::Functions load(const std::function<gl::Function(const char* name)>& find) {
    const auto found = [&](const char* name) {
        const auto function = find(name);
        if (!function) throw io_failed("its OpenGL has no {}", name);
        return function;
    };
    gl::Functions functions;
#define X(name) functions.name = reinterpret_cast<decltype(functions.name)>(found("gl" #name));
    DOPPEL_GL_FUNCTIONS(X)
#undef X
    return functions;
}

constinit thread_local Context* current = nullptr;  // the context that is current in this thread

/// Sets environment variables that Mesa reads, unless the user has set them.
bool set_mesa_defaults() {
    setenv("LP_NUM_THREADS", "0", 0);     // llvmpipe draws in the calling thread; the other cores have other work
    setenv("EGL_LOG_LEVEL", "fatal", 0);  // no messages about drivers that were tried and failed
    return true;
}

/// The part of GL/osmesa.h that Doppel uses. Mesa dropped that header in version 25.1.
namespace osmesa {
using Handle = struct osmesa_context*;
using Create = Handle (*)(const int* attributes, Handle shared_with);
using MakeCurrent = GLboolean (*)(Handle context, void* pixels, GLenum type, GLsizei width, GLsizei height);
using Destroy = void (*)(Handle context);
using Address = gl::Function (*)(const char* name);
constexpr int format = 0x22, profile = 0x33, core_profile = 0x34, major_version = 0x36, minor_version = 0x37;
}  // namespace osmesa

std::unique_ptr<Context> osmesa_context(const std::vector<std::string>& names) {
    const SharedLibrary library(names);
    const osmesa::Create create = library["OSMesaCreateContextAttribs"];
    const osmesa::MakeCurrent make_current = library["OSMesaMakeCurrent"];
    const osmesa::Destroy destroy = library["OSMesaDestroyContext"];
    const osmesa::Address find = library["OSMesaGetProcAddress"];
    // clang-format off
    const int attributes[] = {osmesa::format, GL_RGBA, osmesa::profile, osmesa::core_profile,
                              osmesa::major_version, 3, osmesa::minor_version, 3, 0};
    // clang-format on
    const osmesa::Handle context = create(attributes, nullptr);
    if (!context) throw io_failed("it gives no OpenGL 3.3 core context");
    // one pixel, which OSMesa requires; drawing goes to framebuffer objects
    const auto window = std::make_shared<std::array<unsigned char, 4>>();
    const auto bind = [=] {
        if (!make_current(context, window->data(), GL_UNSIGNED_BYTE, 1, 1))
            throw io_failed("it made an OpenGL context but cannot use it");
    };
    const auto release = [=] { make_current(nullptr, nullptr, 0, 0, 0); };
    return std::make_unique<Context>(Context::Functions{"OSMesa", bind, release, [=] { destroy(context); }, find});
}

std::unique_ptr<Context> egl_context(const std::vector<std::string>& names) {
    const SharedLibrary library(names);
    const decltype(&eglGetPlatformDisplay) platform_display = library["eglGetPlatformDisplay"];
    const decltype(&eglInitialize) initialize = library["eglInitialize"];
    const decltype(&eglBindAPI) bind_api = library["eglBindAPI"];
    const decltype(&eglChooseConfig) choose_config = library["eglChooseConfig"];
    const decltype(&eglCreateContext) create = library["eglCreateContext"];
    const decltype(&eglMakeCurrent) make_current = library["eglMakeCurrent"];
    const decltype(&eglDestroyContext) destroy = library["eglDestroyContext"];
    const decltype(&eglGetProcAddress) find = library["eglGetProcAddress"];
    const decltype(&eglGetError) error = library["eglGetError"];
    const auto check = [=](bool done, const char* otherwise) {
        if (!done) throw io_failed("it {} (EGL error {:#x})", otherwise, error());
    };
    // all contexts of the process share one display, so none of them may terminate it
    const EGLDisplay display = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    check(display != EGL_NO_DISPLAY, "has no Mesa, which draws without a display");
    check(initialize(display, nullptr, nullptr), "finds no driver that draws without a display");
    check(bind_api(EGL_OPENGL_API), "has no OpenGL");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    check(choose_config(display, wanted, &config, 1, &configs) && configs > 0, "has no OpenGL");
    const EGLint attributes[] = {
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    const EGLContext context = create(display, config, EGL_NO_CONTEXT, attributes);
    check(context != EGL_NO_CONTEXT, "gives no OpenGL 3.3 core context");
    const auto bind = [=] {
        check(make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context),
              "made an OpenGL context but cannot use it without a surface");
    };
    const auto release = [=] { make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); };
    return std::make_unique<Context>(
        Context::Functions{"EGL", bind, release, [=] { destroy(display, context); }, find});
}

/// On failure returns null and adds the reason to `errors`. `packages` are Debian's.
std::unique_ptr<Context> try_library(const char* library, const char* packages,
                                     std::unique_ptr<Context> (*make)(const std::vector<std::string>&),
                                     const std::vector<std::string>& names, std::string& errors) {
    try {
        auto context = make(names);
        context->make_current();
        return context;
    } catch (const Error& error) {
        errors += fmt::format("{}{} cannot draw here: {} (in Debian: {})", errors.empty() ? "" : "; ", library,
                              error.what(), packages);
        return nullptr;
    }
}

}  // namespace

Context::~Context() {
    retire();
    own_.destroy();
}

void Context::make_current() {
    if (current == this) return;
    // the libraries are independent: the old context must be released before the new one becomes current
    if (current) current->retire();
    own_.bind();
    current = this;
    if (!opengl_) opengl_ = load(own_.find);
    gl::current = &*opengl_;
}

void Context::retire() {
    if (current != this) return;
    own_.release();
    current = nullptr;
    gl::current = nullptr;
}

std::unique_ptr<Context> make_context(Gl gl, const GlLibraries& libraries) {
    [[maybe_unused]] static const bool done = set_mesa_defaults();  // only once: setenv() is not thread-safe
    std::string errors;
    std::unique_ptr<Context> context;
    if (gl != Gl::egl) context = try_library("OSMesa", "libosmesa6", osmesa_context, libraries.osmesa, errors);
    if (!context && gl != Gl::osmesa)
        context = try_library("EGL", "libegl1, libegl-mesa0, libgl1-mesa-dri", egl_context, libraries.egl, errors);
    if (!context) throw Error(ExitCode::io_failed, errors);
    return context;
}

}  // namespace doppel

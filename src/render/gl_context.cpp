#include "render/gl_context.hpp"

#include "base/error.hpp"
#include "base/shared_library.hpp"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
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
#define X(name) functions.name = reinterpret_cast<decltype(functions.name)>(found("gl" #name));
    DOPPEL_GL_FUNCTIONS(X)
#undef X
    return functions;
}

}  // namespace doppel::gl

namespace doppel {
namespace {

constexpr std::array<std::pair<const char*, Gl>, 3> by_name{
    {{"auto", Gl::automatic}, {"osmesa", Gl::osmesa}, {"egl", Gl::egl}}};

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

class OsmesaContext final : public Context {
public:
    explicit OsmesaContext(const std::vector<std::string>& libraries) : library_(libraries) {
        // clang-format off
        const int attributes[] = {osmesa::format, GL_RGBA, osmesa::profile, osmesa::core_profile,
                                  osmesa::major_version, 3, osmesa::minor_version, 3, 0};
        // clang-format on
        context_ = create_(attributes, nullptr);
        if (!context_) throw io_failed("it gives no OpenGL 3.3 core context");
    }
    ~OsmesaContext() override {
        retire();
        destroy_(context_);
    }
    std::string library() const override { return "OSMesa"; }

private:
    void bind() override {
        if (!make_current_(context_, window_.data(), GL_UNSIGNED_BYTE, 1, 1))
            throw io_failed("it made an OpenGL context but cannot use it");
    }
    void release() override { make_current_(nullptr, nullptr, 0, 0, 0); }
    gl::Function function(const char* name) const override { return address_(name); }

    const SharedLibrary library_;
    osmesa::Create create_ = library_["OSMesaCreateContextAttribs"];
    osmesa::MakeCurrent make_current_ = library_["OSMesaMakeCurrent"];
    osmesa::Destroy destroy_ = library_["OSMesaDestroyContext"];
    osmesa::Address address_ = library_["OSMesaGetProcAddress"];
    osmesa::Handle context_ = nullptr;
    std::array<unsigned char, 4> window_{};  // one pixel, which OSMesa requires; drawing goes to framebuffer objects
};

class EglContext final : public Context {
public:
    explicit EglContext(const std::vector<std::string>& libraries) : library_(libraries) {
        // all contexts of the process share one display, so none of them may terminate it
        display_ = platform_display_(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        check(display_ != EGL_NO_DISPLAY, "has no Mesa, which draws without a display");
        check(initialize_(display_, nullptr, nullptr), "finds no driver that draws without a display");
        check(bind_api_(EGL_OPENGL_API), "has no OpenGL");
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint configs = 0;
        check(choose_config_(display_, wanted, &config, 1, &configs) && configs > 0, "has no OpenGL");
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = create_(display_, config, EGL_NO_CONTEXT, attributes);
        check(context_ != EGL_NO_CONTEXT, "gives no OpenGL 3.3 core context");
    }
    ~EglContext() override {
        retire();
        destroy_(display_, context_);
    }
    std::string library() const override { return "EGL"; }

private:
    void bind() override {
        check(make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_),
              "made an OpenGL context but cannot use it without a surface");
    }
    void release() override { make_current_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    gl::Function function(const char* name) const override { return address_(name); }

    void check(bool done, const char* otherwise) const {
        if (!done) throw io_failed("it {} (EGL error {:#x})", otherwise, error_());
    }

    const SharedLibrary library_;
    decltype(&eglGetPlatformDisplay) platform_display_ = library_["eglGetPlatformDisplay"];
    decltype(&eglInitialize) initialize_ = library_["eglInitialize"];
    decltype(&eglBindAPI) bind_api_ = library_["eglBindAPI"];
    decltype(&eglChooseConfig) choose_config_ = library_["eglChooseConfig"];
    decltype(&eglCreateContext) create_ = library_["eglCreateContext"];
    decltype(&eglMakeCurrent) make_current_ = library_["eglMakeCurrent"];
    decltype(&eglDestroyContext) destroy_ = library_["eglDestroyContext"];
    decltype(&eglGetProcAddress) address_ = library_["eglGetProcAddress"];
    decltype(&eglGetError) error_ = library_["eglGetError"];
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

/// Makes a context of this library current. On failure returns null and adds the reason to `errors`. `packages` are
/// Debian's.
template <class LibraryContext>
std::unique_ptr<Context> try_library(const char* library, const char* packages, const std::vector<std::string>& names,
                                     std::string& errors) {
    try {
        std::unique_ptr<Context> context = std::make_unique<LibraryContext>(names);
        context->make_current();
        return context;
    } catch (const Error& error) {
        errors += fmt::format("{}{} cannot draw here: {} (in Debian: {})", errors.empty() ? "" : "; ", library,
                              error.what(), packages);
        return nullptr;
    }
}

}  // namespace

std::vector<std::string> gl_names() {
    std::vector<std::string> all;
    for (const auto& [name, gl] : by_name) all.emplace_back(name);
    return all;
}

Gl gl_named(const std::string& name) {
    const auto found =
        std::find_if(by_name.begin(), by_name.end(), [&](const auto& known) { return known.first == name; });
    if (found == by_name.end())
        throw bad_input("nothing that draws is called \"{}\"; there are {}", name, fmt::join(gl_names(), ", "));
    return found->second;
}

void Context::make_current() {
    if (current == this) return;
    // the libraries are independent: the old context must be released before the new one becomes current
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
    [[maybe_unused]] static const bool done = set_mesa_defaults();  // only once: setenv() is not thread-safe
    std::string errors;
    std::unique_ptr<Context> context;
    if (gl != Gl::egl) context = try_library<OsmesaContext>("OSMesa", "libosmesa6", libraries.osmesa, errors);
    if (!context && gl != Gl::osmesa)
        context = try_library<EglContext>("EGL", "libegl1, libegl-mesa0, libgl1-mesa-dri", libraries.egl, errors);
    if (!context) throw Error(ExitCode::io_failed, errors);
    return context;
}

}  // namespace doppel

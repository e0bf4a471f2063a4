// OSMesa and EGL, found at run time.
#include "base/error.hpp"
#include "render/gl_context.hpp"

#include <GL/osmesa.h>
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>

namespace doppel {
namespace {

/// The functions of OSMesa that Doppel calls.
struct Osmesa {
    explicit Osmesa(const Library& library) {
        library.find("OSMesaCreateContextAttribs", create);
        library.find("OSMesaMakeCurrent", make_current);
        library.find("OSMesaDestroyContext", destroy);
        library.find("OSMesaGetProcAddress", function);
    }
    decltype(&OSMesaCreateContextAttribs) create;
    decltype(&OSMesaMakeCurrent) make_current;
    decltype(&OSMesaDestroyContext) destroy;
    decltype(&OSMesaGetProcAddress) function;
};

class OsmesaContext final : public Context {
public:
    explicit OsmesaContext(const std::vector<std::string>& libraries) : osmesa_(Library(libraries)) {
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = osmesa_.create(attributes, nullptr);
        if (!context_) throw io_failed("it gives no OpenGL 3.3 core context");
    }
    ~OsmesaContext() override {
        retire();
        osmesa_.destroy(context_);
    }
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;

    std::string library() const override { return "OSMesa"; }

private:
    void bind() override {
        if (!osmesa_.make_current(context_, window_.data(), GL_UNSIGNED_BYTE, 1, 1))
            throw io_failed("it made an OpenGL context but cannot use it");
    }
    void release() override { osmesa_.make_current(nullptr, nullptr, 0, 0, 0); }
    gl::Function function(const char* name) const override { return osmesa_.function(name); }

    Osmesa osmesa_;
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> window_{};  // the one pixel that OSMesa wants; we draw elsewhere
};

/// The functions of EGL that Doppel calls.
struct Egl {
    explicit Egl(const Library& library) {
        library.find("eglGetPlatformDisplay", platform_display);
        library.find("eglInitialize", initialize);
        library.find("eglBindAPI", bind_api);
        library.find("eglChooseConfig", choose_config);
        library.find("eglCreateContext", create);
        library.find("eglMakeCurrent", make_current);
        library.find("eglDestroyContext", destroy);
        library.find("eglGetProcAddress", function);
        library.find("eglGetError", error);
    }
    decltype(&eglGetPlatformDisplay) platform_display;
    decltype(&eglInitialize) initialize;
    decltype(&eglBindAPI) bind_api;
    decltype(&eglChooseConfig) choose_config;
    decltype(&eglCreateContext) create;
    decltype(&eglMakeCurrent) make_current;
    decltype(&eglDestroyContext) destroy;
    decltype(&eglGetProcAddress) function;
    decltype(&eglGetError) error;
};

class EglContext final : public Context {
public:
    explicit EglContext(const std::vector<std::string>& libraries) : egl_(Library(libraries)) {
        // one display serves all contexts of the process, so none of them may terminate it
        display_ = egl_.platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        check(display_ != EGL_NO_DISPLAY, "has no Mesa, which draws without a display");
        check(egl_.initialize(display_, nullptr, nullptr), "finds no driver that draws without a display");
        check(egl_.bind_api(EGL_OPENGL_API), "has no OpenGL");
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint configs = 0;
        check(egl_.choose_config(display_, wanted, &config, 1, &configs) && configs > 0, "has no OpenGL");
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = egl_.create(display_, config, EGL_NO_CONTEXT, attributes);
        check(context_ != EGL_NO_CONTEXT, "gives no OpenGL 3.3 core context");
    }
    ~EglContext() override {
        retire();
        egl_.destroy(display_, context_);
    }
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    std::string library() const override { return "EGL"; }

private:
    void bind() override {
        check(egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_),
              "made an OpenGL context but cannot use it without a surface");
    }
    void release() override { egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    gl::Function function(const char* name) const override { return egl_.function(name); }

    void check(bool done, const char* otherwise) const {
        if (!done) throw io_failed("it {} (EGL error {:#x})", otherwise, egl_.error());
    }

    Egl egl_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context(const std::vector<std::string>& libraries) {
    return std::make_unique<OsmesaContext>(libraries);
}

std::unique_ptr<Context> make_egl_context(const std::vector<std::string>& libraries) {
    return std::make_unique<EglContext>(libraries);
}

}  // namespace doppel

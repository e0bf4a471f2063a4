#include "base/error.hpp"
#include "render/gl_context.hpp"
#include "render/gl_library.hpp"

#include <GL/osmesa.h>

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

}  // namespace

std::unique_ptr<Context> make_osmesa_context(const std::vector<std::string>& libraries) {
    return std::make_unique<OsmesaContext>(libraries);
}

}  // namespace doppel

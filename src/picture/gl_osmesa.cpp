#include "numeric/error.hpp"
#include "picture/gl_context.hpp"

#include <GL/osmesa.h>

#include <array>
#include <cstdlib>

namespace doppel {
namespace {

class OsmesaContext : public Context {
public:
    OsmesaContext() {
        // the threads of the machine have better work than sharing one small picture; the user may think otherwise
        setenv("LP_NUM_THREADS", "0", 0);
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = OSMesaCreateContextAttribs(attributes, nullptr);
        if (!context_) throw io_failed("OSMesa gives no OpenGL 3.3 core context (is libosmesa6 6.5 or newer there?)");
    }
    ~OsmesaContext() override { OSMesaDestroyContext(context_); }
    OsmesaContext(const OsmesaContext&) = delete;
    OsmesaContext& operator=(const OsmesaContext&) = delete;

    void make_current() override {
        if (OSMesaGetCurrentContext() == context_) return;
        if (!OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 1, 1)) {
            throw io_failed("OSMesa made an OpenGL context but cannot use it");
        }
    }

    Function function(const char* name) const override { return OSMesaGetProcAddress(name); }

private:
    OSMesaContext context_ = nullptr;
    std::array<unsigned char, 4> window_{};  // the one pixel that OSMesa wants; we draw elsewhere
};

}  // namespace

std::unique_ptr<Context> make_osmesa_context() {
    return std::make_unique<OsmesaContext>();
}

}  // namespace doppel

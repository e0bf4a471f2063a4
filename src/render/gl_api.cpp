#include "render/gl_api.hpp"

#include "base/error.hpp"

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

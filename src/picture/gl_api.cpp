#include "picture/gl_api.hpp"

#include "numeric/error.hpp"

namespace doppel::gl {

#define X(type, name) type name = nullptr;
DOPPEL_GL_FUNCTIONS(X)
#undef X

void load(const Context& context) {
    const auto find = [&](const char* name) {
        const Context::Function found = context.function(name);
        if (!found) throw io_failed("this OpenGL has no {}", name);
        return found;
    };
#define X(type, name) name = reinterpret_cast<type>(find("gl" #name));
    DOPPEL_GL_FUNCTIONS(X)
#undef X
}

}  // namespace doppel::gl

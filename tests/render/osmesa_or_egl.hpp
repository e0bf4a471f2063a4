#pragma once

#include "base/error.hpp"
#include "render/gl_context.hpp"

#include <string>

namespace doppel::test {

/// What the tests of OSMesa draw with: EGL where this system has no OSMesa, which Mesa dropped with version 25.1.
inline Gl osmesa_or_egl() {
    static const Gl found = [] {
        try {
            make_context(Gl::osmesa);
            return Gl::osmesa;
        } catch (const Error&) {
            return Gl::egl;
        }
    }();
    return found;
}

/// Whose context that is; and what --gl calls it.
inline std::string library_of_osmesa_or_egl() {
    return osmesa_or_egl() == Gl::osmesa ? "OSMesa" : "EGL";
}
inline std::string name_of_osmesa_or_egl() {
    return osmesa_or_egl() == Gl::osmesa ? "osmesa" : "egl";
}

}  // namespace doppel::test

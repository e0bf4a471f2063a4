#pragma once

#include "base/error.hpp"
#include "render/gl_context.hpp"

#include <string>

namespace doppel::test {

/// The backend of the tests of OSMesa: EGL if this system has no OSMesa, which Mesa removed in version 25.1.
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

/// The library of that context, as --gl names it.
inline std::string library_of_osmesa_or_egl() {
    return osmesa_or_egl() == Gl::osmesa ? "OSMesa" : "EGL";
}
inline std::string name_of_osmesa_or_egl() {
    return osmesa_or_egl() == Gl::osmesa ? "osmesa" : "egl";
}

}  // namespace doppel::test

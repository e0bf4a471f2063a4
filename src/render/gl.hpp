#pragma once

#include <string>
#include <vector>

namespace doppel {

/// Whose OpenGL draws; neither wants a display or a GPU. The pixels are the same by the golden policy.
enum class Gl {
    automatic,  // OSMesa, or EGL where OSMesa does not work
    osmesa,     // Mesa drawing in software, into memory
    egl,        // EGL without a surface: a GPU where there is one, otherwise Mesa in software
};

/// What people call them: "auto", "osmesa", "egl".
std::vector<std::string> gl_names();

/// Throws Error (exit 2) where nothing is called so.
Gl gl_named(const std::string& name);

}  // namespace doppel

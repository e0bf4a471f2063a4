#pragma once

#include <string_view>

namespace doppel {

// What the build puts into the program.

/// A file that was built into the program (cmake/embed.cmake).
struct EmbeddedFile {
    std::string_view name;      // without its folder
    std::string_view contents;  // its bytes
};

std::string_view version();   // "1.0.0"
std::string_view revision();  // of git when it was built, "-dirty" if changed since; "unknown" without git

}  // namespace doppel

#pragma once

#include <string_view>

namespace doppel {

/// A file that was built into the program (cmake/embed.cmake).
struct EmbeddedFile {
    std::string_view name;      // without its folder
    std::string_view contents;  // its bytes
};

std::string_view version();   // for example "1.0.0"
std::string_view revision();  // git revision at build time, "-dirty" with uncommitted changes; "unknown" without git

}  // namespace doppel

#pragma once

#include <string_view>

namespace doppel {

/// A file that was built into the program (cmake/embed.cmake).
struct EmbeddedFile {
    std::string_view name;      // without its folder
    std::string_view contents;  // its bytes
};

}  // namespace doppel

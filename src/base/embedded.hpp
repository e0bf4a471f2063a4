#pragma once

#include "base/error.hpp"

#include <span>
#include <string_view>

namespace doppel {

/// A file that was built into the program (cmake/embed.cmake).
struct EmbeddedFile {
    std::string_view name;      // without its folder
    std::string_view contents;  // its bytes
};

/// The contents of one of them. Throws Error (exit 4) if it was not built in.
inline std::string_view embedded_file(std::span<const EmbeddedFile> files, std::string_view name) {
    for (const auto& file : files)
        if (file.name == name) return file.contents;
    throw io_failed("{} was not built in", name);
}

std::string_view version();   // for example "1.0.0"
std::string_view revision();  // git revision at build time, "-dirty" with uncommitted changes; "unknown" without git

}  // namespace doppel

#pragma once

#include "output/folder.hpp"

#include <string>
#include <string_view>

namespace doppel {

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const FilePlace& place);

/// The same of a text.
std::string sha256_of_text(std::string_view text);

}  // namespace doppel

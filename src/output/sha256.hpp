#pragma once

#include <filesystem>
#include <string>

namespace doppel {

/// SHA-256 of a file's bytes, 64 lower-case hexadecimal digits. Throws Error (exit 4) where it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace doppel

#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace doppel {

/// The kind of file that a reader accepts.
struct WantedFile {
    std::string_view what;  // "a track is a CSV file"
    std::size_t max_bytes;
    std::string_view missing = "there is no such file";
};

/// Reads a whole regular file; links are followed. With `stop`, a pipe is read, too, until `stop` is set; otherwise
/// pipes and devices are refused at once. Throws Error: exit 2 if the file is missing, of another kind or too long;
/// exit 4 if it cannot be read; exit 130.
std::string read_whole_file(const std::filesystem::path& path, const WantedFile& wanted,
                            const std::atomic<bool>* stop = nullptr);

}  // namespace doppel

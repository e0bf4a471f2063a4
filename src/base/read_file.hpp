#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace doppel {

/// What a reader takes.
struct WantedFile {
    std::string_view what;  // "a track is a CSV file"
    std::size_t most_bytes;
    std::string_view missing = "there is no such file";
};

/// All of a regular file, links followed; where `stop` is given, also what comes through a pipe, until it is set. Does
/// not wait for anything else: a pipe or device is refused at once. Throws Error: exit 2 where there is none, it is of
/// another kind, or too long; exit 4 where it cannot be read; exit 130.
std::string read_whole_file(const std::filesystem::path& path, const WantedFile& wanted,
                            const std::atomic<bool>* stop = nullptr);

}  // namespace doppel

#pragma once

#include "output/folder.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace doppel {

/// A file being written. Every failure, a full disk included, is an Error (exit 4) with the path and the system's
/// reason.
class OutputFile {
public:
    /// Opens it, empty.
    explicit OutputFile(const FilePlace& place);

    void write(std::string_view bytes);
    /// What was written so far can be read by others.
    void flush();
    /// Only what was closed is known to be written.
    void close();

    const std::filesystem::path& path() const { return path_; }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path path_;
    std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace doppel

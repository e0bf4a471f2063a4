#pragma once

#include "base/owned.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

class Error;

using Stream = Owned<std::FILE, std::fclose>;
/// Opens with flags of open(2) and a mode of fdopen(3); null on failure, with the reason in errno.
Stream open_stream(const std::filesystem::path& path, int flags, const char* mode);
/// Creates an empty file for writing and reading, replacing an older one; follows no link. Throws Error (exit 4).
Stream create_file(const std::filesystem::path& path);
/// Opens a regular file for reading. Throws Error (exit 4).
Stream open_file(const std::filesystem::path& path);

/// The first bytes of a regular file, at most `maximum`; empty if it cannot be read.
std::string start_of_file(const std::filesystem::path& path, std::size_t maximum);
/// The type of what has this name; links are not followed.
std::filesystem::file_type type_of(const std::filesystem::path& path);
/// The names in a folder, sorted. Throws Error (exit 4).
std::vector<std::string> names_in(const std::filesystem::path& folder);
/// rename(2): an older file `to` is replaced. Throws Error (exit 4).
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// A file being written. Every failure, such as a full disk, throws Error (exit 4) with the path and the system's
/// reason.
class OutputFile {
public:
    /// Opens it, empty.
    explicit OutputFile(const std::filesystem::path& path) : path_(path), file_(create_file(path)) {}

    void write(std::string_view bytes);
    void flush();
    /// Closes the file and reports delayed write errors. A file destroyed without close() may be incomplete.
    void close();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    Stream file_;
};

/// Writes the text as a whole file.
void write_file(const std::filesystem::path& path, std::string_view text);

/// A new folder, removed with its files by the destructor. Throws Error (exit 4).
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

/// The error "PATH: cannot be WHAT: reason of the system", exit 4.
Error cannot(const std::filesystem::path& path, std::string_view what, int reason = errno);

}  // namespace doppel

#pragma once

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

class Error;

/// A pointer from a library in C and the function that frees it.
template <auto destroy>
struct Destroy {
    void operator()(auto* thing) const { destroy(thing); }
};
template <class T, auto destroy>
using Owned = std::unique_ptr<T, Destroy<destroy>>;

using Stream = Owned<std::FILE, std::fclose>;
/// By flags of open(2) and a mode of fdopen(3); null where that fails, and errno says why.
Stream open_stream(const std::filesystem::path& path, int flags, const char* mode);
/// A new empty file, to write and read, in place of an older one; no link is followed. Throws Error (exit 4).
Stream create_file(const std::filesystem::path& path);
/// A regular file to read. Throws Error (exit 4).
Stream open_file(const std::filesystem::path& path);

/// The first bytes of a regular file, at most `most`; none where it cannot be read.
std::string start_of_file(const std::filesystem::path& path, std::size_t most);
/// What has this name; a symbolic link is one.
std::filesystem::file_type type_of(const std::filesystem::path& path);
/// The names in a folder, sorted. Throws Error (exit 4).
std::vector<std::string> names_in(const std::filesystem::path& folder);
/// rename(2): an older file `to` is replaced. Throws Error (exit 4).
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// A file being written. Every failure, a full disk included, is an Error (exit 4) with the path and the system's
/// reason.
class OutputFile {
public:
    /// Opens it, empty.
    explicit OutputFile(const std::filesystem::path& path) : path_(path), file_(create_file(path)) {}

    void write(std::string_view bytes);
    void flush();
    /// Reports errors that show only now; what is destroyed unclosed may be incomplete.
    void close();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    Stream file_;
};

/// The same of a text.
void write_file(const std::filesystem::path& path, std::string_view text);

/// A new folder for files that nobody keeps, removed with this. Throws Error (exit 4).
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

/// "PATH: cannot be WHAT: the system's reason", exit 4.
Error cannot(const std::filesystem::path& path, std::string_view what, int reason = errno);

}  // namespace doppel

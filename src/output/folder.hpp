#pragma once

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

class Error;

/// A file descriptor, closed with its owner.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(other.release()) {}
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();

    int number() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }
    /// The caller closes it from now on.
    int release();

private:
    int number_;
};

/// An entry of a folder.
struct Entry {
    enum class Kind { none, file, folder, link, other } kind = Kind::none;  // other: a pipe, socket or device
    ino_t inode = 0;
    nlink_t names = 0;  // hard links to it
    std::uintmax_t bytes = 0;
};

/// A folder, held open: all calls refer to it, even if its path is replaced, and follow no symbolic link in it. All but
/// the queries throw Error (exit 4) with the path and the system's reason.
class Folder {
public:
    /// Links in `path` are followed.
    static Folder at(const std::filesystem::path& path);
    /// The folder `name` in this one, not through a link; `shown` is its path in messages, where given.
    Folder folder(const std::string& name, const std::filesystem::path& shown = {}) const;

    const std::filesystem::path& path() const { return path_; }  // for messages
    int descriptor() const { return descriptor_.number(); }

    Entry entry(const std::string& name) const;
    /// All names but "." and "..", sorted.
    std::vector<std::string> names() const;

    void make_folder(const std::string& name) const;
    /// rename(2): an older file `to` is replaced.
    void rename(const std::string& from, const std::string& to) const;
    /// Swaps two names atomically. False where the file system cannot.
    bool exchange(const std::string& one, const std::string& other) const;
    /// A file, or a folder and the files in it, if it exists. Throws where the folder holds folders, or `name` is of
    /// another kind.
    void remove(const std::string& name) const;
    /// Flushes the folder's entries to the disk; all files of this file system too where `contents`.
    void sync(bool contents = false) const;

private:
    Folder(std::filesystem::path path, Descriptor descriptor);

    std::filesystem::path path_;
    Descriptor descriptor_;
};

/// Makes `folder` and its missing parents; returns those that it made, outermost first. Safe beside other runs. Throws
/// Error (exit 4), and then removes them again.
std::vector<std::filesystem::path> make_folders(const std::filesystem::path& folder);
/// Removes those that are empty.
void remove_folders(const std::vector<std::filesystem::path>& folders);

/// Where a file is: in an open folder, or at a path.
struct FilePlace {
    FilePlace(std::filesystem::path where) : name(where.string()), path(std::move(where)) {}  // NOLINT: a path is one
    FilePlace(const Folder& in, const std::string& as) : folder(&in), name(as), path(in.path() / as) {}

    /// The folder's, or AT_FDCWD.
    int descriptor() const;

    const Folder* folder = nullptr;  // which outlives the place
    std::string name;                // the path, where there is no folder
    std::filesystem::path path;      // for messages, where there is a folder
};

/// rename(2): an older file `to` is replaced. Throws Error (exit 4).
void rename_file(const FilePlace& from, const FilePlace& to);
/// "NAME.part" beside it.
FilePlace part_of(const FilePlace& place);

/// A new empty file, to write and read; in a folder its name must be free. Throws Error (exit 4).
Descriptor create_file(const FilePlace& place);
/// A file without a name on the file system of `place`, to write and read; closing it frees it. Throws Error (exit 4).
Descriptor create_unnamed_file(const FilePlace& place);
/// A regular file to read; in a folder no link. Throws Error (exit 4).
Descriptor open_file(const FilePlace& place);

/// A pointer from a library in C and the function that frees it.
template <auto destroy>
struct Destroy {
    void operator()(auto* thing) const { destroy(thing); }
};
template <class T, auto destroy>
using Owned = std::unique_ptr<T, Destroy<destroy>>;

using Stream = Owned<std::FILE, std::fclose>;
/// The file, buffered, in a mode of fdopen(3). Throws Error (exit 4) that says `what` it cannot be.
Stream stream_of(Descriptor file, const char* mode, const std::filesystem::path& path, std::string_view what);

/// A file being written. Every failure, a full disk included, is an Error (exit 4) with the path and the system's
/// reason.
class OutputFile {
public:
    /// Opens it, empty.
    explicit OutputFile(const FilePlace& place);

    void write(std::string_view bytes);
    void flush();
    /// Reports errors that show only now; what is destroyed unclosed may be incomplete.
    void close();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    Stream file_;
};

/// A small file, in place of an older one; it appears whole or not at all. Throws Error (exit 4).
void write_file(const std::filesystem::path& path, std::string_view text);

/// "PATH: cannot be WHAT: the system's reason", exit 4, by errno or the given number.
Error cannot(const std::filesystem::path& path, std::string_view what);
Error cannot(const std::filesystem::path& path, std::string_view what, int reason);

}  // namespace doppel

#include "output/folder.hpp"

#include "base/error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <system_error>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

constexpr int as_folder = O_RDONLY | O_DIRECTORY | O_CLOEXEC;

Entry entry_of(const struct stat& status) {
    using Kind = Entry::Kind;
    const auto kind = S_ISREG(status.st_mode)   ? Kind::file
                      : S_ISDIR(status.st_mode) ? Kind::folder
                      : S_ISLNK(status.st_mode) ? Kind::link
                                                : Kind::other;
    return {kind, status.st_ino, status.st_nlink, static_cast<std::uintmax_t>(status.st_size)};
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    if (this != &other) {
        if (number_ >= 0) close(number_);
        number_ = other.release();
    }
    return *this;
}

Descriptor::~Descriptor() {
    if (number_ >= 0) close(number_);
}

int Descriptor::release() {
    return std::exchange(number_, -1);
}

Folder::Folder(fs::path path, Descriptor descriptor) : path_(std::move(path)), descriptor_(std::move(descriptor)) {}

Folder Folder::at(const fs::path& path) {
    Descriptor opened(open(path.c_str(), as_folder));
    if (!opened) throw cannot(path, "opened");
    return {path, std::move(opened)};
}

Folder Folder::folder(const std::string& name, const fs::path& shown) const {
    const auto path = shown.empty() ? path_ / name : shown;
    Descriptor opened(openat(descriptor(), name.c_str(), as_folder | O_NOFOLLOW));
    if (!opened) throw cannot(path, "opened");
    return {path, std::move(opened)};
}

Entry Folder::entry(const std::string& name) const {
    struct stat status {};
    if (fstatat(descriptor(), name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return {};
    return entry_of(status);
}

std::vector<std::string> Folder::names() const {
    struct Close {
        void operator()(DIR* stream) const { closedir(stream); }
    };
    Descriptor again(openat(descriptor(), ".", as_folder));
    const std::unique_ptr<DIR, Close> stream(again ? fdopendir(again.number()) : nullptr);
    if (!stream) throw cannot(path_, "read");
    again.release();  // the stream's now
    std::vector<std::string> names;
    while (const dirent* entry = readdir(stream.get()))
        if (const std::string_view name = entry->d_name; name != "." && name != "..") names.emplace_back(name);
    std::sort(names.begin(), names.end());
    return names;
}

void Folder::make_folder(const std::string& name) const {
    if (mkdirat(descriptor(), name.c_str(), 0777) != 0) throw cannot(path_ / name, "made");
}

void Folder::rename(const std::string& from, const std::string& to) const {
    rename_file({*this, from}, {*this, to});
}

bool Folder::exchange(const std::string& one, const std::string& other) const {
    if (renameat2(descriptor(), one.c_str(), descriptor(), other.c_str(), RENAME_EXCHANGE) == 0) return true;
    if (errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP) return false;
    throw cannot(path_ / one, "renamed to " + other);
}

void Folder::remove(const std::string& name) const {
    const auto failed = [&](int flags) { return unlinkat(descriptor(), name.c_str(), flags) != 0; };
    const auto kind = entry(name).kind;
    if (kind == Entry::Kind::none) return;
    if (kind != Entry::Kind::file && kind != Entry::Kind::folder)
        throw io_failed("{} is no file of Doppel's; remove it", (path_ / name).string());
    if (kind == Entry::Kind::folder) {
        const Folder inside = folder(name);
        for (const auto& file : inside.names())
            if (inside.entry(file).kind == Entry::Kind::file) inside.remove(file);
    }
    if (failed(kind == Entry::Kind::folder ? AT_REMOVEDIR : 0) && errno != ENOENT)
        throw cannot(path_ / name, "removed");
}

void Folder::sync(bool contents) const {
    // errors of file systems without sync
    const auto failed = [](int result) { return result != 0 && errno != EINVAL && errno != ENOSYS && errno != EROFS; };
    if ((contents && failed(syncfs(descriptor()))) || failed(fsync(descriptor()))) throw cannot(path_, "written");
}

void remove_folders(const std::vector<fs::path>& folders) {
    for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) rmdir(folder->c_str());
}

std::vector<fs::path> make_folders(const fs::path& folder) {
    std::vector<fs::path> made;
    fs::path way;
    for (const fs::path& step : folder) {
        way /= step;
        std::error_code error, ignored;
        while (!fs::is_directory(way, ignored)) {
            if (fs::create_directory(way, error)) made.push_back(way);
            if (!error) continue;
            remove_folders(made);
            if (fs::exists(fs::symlink_status(way, ignored)))
                throw io_failed("{} is no folder; Doppel would write into a folder there", way.string());
            throw io_failed("{}: the folder cannot be made: {}", way.string(), error.message());
        }
    }
    return made;
}

int FilePlace::descriptor() const {
    return folder ? folder->descriptor() : AT_FDCWD;
}

void rename_file(const FilePlace& from, const FilePlace& to) {
    if (renameat(from.descriptor(), from.name.c_str(), to.descriptor(), to.name.c_str()) != 0)
        throw cannot(from.path, "renamed to " + to.path.filename().string());
}

void write_file(const std::filesystem::path& path, std::string_view text) {
    const auto folder = Folder::at(path.has_parent_path() ? path.parent_path() : ".");
    const FilePlace place(folder, path.filename().string()), part = part_of(place);
    OutputFile file(part);  // a new file: what stands there already is somebody's
    try {
        file.write(text);
        file.close();
        rename_file(part, place);
    } catch (...) {
        folder.remove(part.name);
        throw;
    }
}

FilePlace part_of(const FilePlace& place) {
    return place.folder ? FilePlace(*place.folder, place.name + ".part") : FilePlace(place.path.string() + ".part");
}

Descriptor create_file(const FilePlace& place) {
    const int fresh = place.folder ? O_EXCL | O_NOFOLLOW : O_TRUNC;
    Descriptor file(openat(place.descriptor(), place.name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | fresh, 0666));
    if (!file) throw cannot(place.path, "written");
    return file;
}

Descriptor create_unnamed_file(const FilePlace& place) {
    constexpr int unnamed = O_RDWR | O_TMPFILE | O_CLOEXEC;
    const auto parent = place.path.has_parent_path() ? place.path.parent_path() : fs::path(".");
    Descriptor file(openat(place.descriptor(), place.folder ? "." : parent.c_str(), unnamed, 0600));
    if (file) return file;
    if (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL) throw cannot(place.path, "written");
    // file systems without O_TMPFILE: it has a name for a moment
    const auto name = place.path.filename().string() + ".spool";
    const Folder folder = place.folder ? place.folder->folder(".") : Folder::at(parent);
    file = create_file({folder, name});
    folder.remove(name);
    return file;
}

Descriptor open_file(const FilePlace& place) {
    // opening a pipe without a writer would block
    const int careful = O_NONBLOCK | (place.folder ? O_NOFOLLOW : 0);
    Descriptor file(openat(place.descriptor(), place.name.c_str(), O_RDONLY | O_CLOEXEC | careful));
    if (!file) throw cannot(place.path, "read");
    struct stat status {};
    if (fstat(file.number(), &status) != 0) throw cannot(place.path, "read");
    if (!S_ISREG(status.st_mode)) throw io_failed("{} is not a regular file", place.path.string());
    return file;
}

Stream stream_of(Descriptor file, const char* mode, const fs::path& path, std::string_view what) {
    Stream stream(fdopen(file.number(), mode));
    if (!stream) throw cannot(path, what);
    file.release();  // closed with the stream
    return stream;
}

OutputFile::OutputFile(const FilePlace& place)
    : path_(place.path), file_(stream_of(create_file(place), "wb", path_, "written")) {}

void OutputFile::write(std::string_view bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) throw cannot(path_, "written");
}

void OutputFile::flush() {
    if (std::fflush(file_.get()) != 0) throw cannot(path_, "written");
}

void OutputFile::close() {
    // flushes the last bytes
    if (std::fclose(file_.release()) != 0) throw cannot(path_, "written");
}

Error cannot(const fs::path& path, std::string_view what) {
    return cannot(path, what, errno);
}

Error cannot(const fs::path& path, std::string_view what, int reason) {
    return io_failed("{}: cannot be {}: {}", path.string(), what, std::generic_category().message(reason));
}

}  // namespace doppel

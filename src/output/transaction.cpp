#include "output/transaction.hpp"

#include "base/error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace doppel {
namespace {

namespace fs = std::filesystem;

using Type = fs::file_type;

/// Contains the process, a line 'part "NAME"' for each name that the run uses in the hidden folder, and, once all files
/// are on the disk, a line "publish INODE …" with the new folders.
constexpr const char* lock_name = ".lock";
/// A replaced folder, if the file system cannot exchange two names.
constexpr const char* backup_name = ".old";

Error not_ours(const fs::path& path) {
    return io_failed("{} may not be Doppel's: no manifest lists it; move it, or give another folder with --out",
                     path.string());
}

/// Throws if the name is used by something of another type; follows no link.
void require_type(const fs::path& path, bool is_folder) {
    std::error_code error;
    const auto type = fs::symlink_status(path, error).type();
    if (type == Type::not_found || type == (is_folder ? Type::directory : Type::regular)) return;
    if (type == Type::none) throw cannot(path, "reached", error.value());
    throw io_failed("{} is {}; Doppel would {} there", path.string(),
                    type == Type::symlink     ? "a symbolic link"
                    : type == Type::directory ? "a folder"
                    : type == Type::regular   ? "a file"
                                              : "neither a file nor a folder",
                    is_folder ? "make a folder" : "write a file");
}

/// The path without missing folders that it leaves by "..": of x/../y, y.
fs::path without_detours(const fs::path& path) {
    fs::path way;
    for (const fs::path& step : path)
        way = step == ".." && way.has_filename() && type_of(way) == Type::not_found ? way.parent_path() : way / step;
    return way.empty() ? "." : way;
}

ino_t inode_of(const fs::path& path) {
    struct stat status {};
    return lstat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

void append(const Stream& file, const std::string& text, const fs::path& path) {
    const auto written = write(fileno(file.get()), text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size())) throw cannot(path, "written", written < 0 ? errno : ENOSPC);
}

/// "000000.png" of a film, "1-0-1.png" of a map of tiles.
bool is_numbered(const std::string& name) {
    return name.ends_with(".png") && name.find_first_not_of("0123456789-") == name.size() - 4;
}

/// Removes a file; or of a folder its numbered pictures, and the folder itself if nothing else is in it.
void remove_made(const fs::path& path) {
    const auto remove = [](const fs::path& made) {
        std::error_code error;
        if (!fs::remove(made, error) && error && error != std::errc::directory_not_empty)
            throw cannot(made, "removed", error.value());
    };
    if (type_of(path) == Type::directory)
        for (const auto& file : names_in(path))
            if (is_numbered(file)) remove(path / file);
    remove(path);
}

/// Flushes it to the disk. Ignores errors of file systems that do not support this.
void sync(int file, const fs::path& path) {
    if (fsync(file) != 0 && errno != EINVAL && errno != ENOSYS && errno != EROFS) throw cannot(path, "written");
}

void sync_folder(const fs::path& path, bool with_files = false) {
    const Owned<DIR, closedir> folder(opendir(path.c_str()));
    if (!folder || (with_files && syncfs(dirfd(folder.get())) != 0 && errno != ENOSYS)) throw cannot(path, "written");
    sync(dirfd(folder.get()), path);
}

}  // namespace

Transaction::Transaction(const fs::path& folder, const std::string& run, std::string kind, Replacing replacing)
    : Transaction(folder, std::move(kind), std::move(replacing)) {
    hidden_ = folder_ / (".doppel-" + run);
    // from here on the destructor undoes the steps if one throws
    make_folders();
    while (!lock()) continue;
    if (replacing_.reads_manifests) written_ = written_files(folder_);
    recover();
    begin();
    for (const auto& name : names_in(hidden_))
        if (name != lock_name) throw not_ours(hidden(name));
}

Transaction::Transaction(const fs::path& folder, std::string kind, Replacing replacing)
    : folder_(without_detours(folder)), kind_(std::move(kind)), replacing_(std::move(replacing)) {}

Transaction::~Transaction() {
    try {
        for (const Part& part : parts_)
            if (!part.finished) remove_made(hidden(part.name));
        if (lock_ && !keeps_hidden_) {
            clear();
            unlink(hidden(lock_name).c_str());  // while this process still has the lock: no other run uses the file
        }
    } catch (const Error&) {
        // files that cannot be removed stay, and their names in the lock file
    }
    rmdir(hidden_.c_str());  // removed if it is empty, as are the folders
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) rmdir(made->c_str());
}

void Transaction::make_folders() {
    require_type(folder_, true);
    fs::path way;
    for (const fs::path& step : folder_) {
        way /= step;
        std::error_code error, ignored;
        while (!fs::is_directory(way, ignored)) {  // again if another run removes it
            if (fs::create_directory(way, error)) made_.push_back(way);
            if (!error) continue;
            require_type(way, true);
            throw Error(code_of_errno(error.value()),
                        fmt::format("{}: the folder cannot be made: {}", way.string(), error.message()));
        }
    }
}

/// Makes and locks the hidden folder. Returns false if another process has removed it meanwhile.
bool Transaction::lock() {
    const bool is_new = mkdir(hidden_.c_str(), 0777) == 0;
    if (!is_new && errno != EEXIST) throw cannot(folder_, "written to");
    require_type(hidden_, true);
    const auto path = hidden(lock_name);
    auto file = open_stream(path, O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_NONBLOCK, "a+");
    if (!file && errno == ENOENT) return false;
    if (!file) throw cannot(folder_, "written to");
    const int error = flock(fileno(file.get()), LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
    struct stat status {};
    fstat(fileno(file.get()), &status);
    if (error == EINTR || (error == 0 && inode_of(path) != status.st_ino)) return false;
    const bool knows_no_locks = error == ENOLCK || error == EOPNOTSUPP || error == ENOSYS;
    if (error == 0 || (knows_no_locks && is_new)) {
        lock_ = std::move(file);
        return true;
    }
    if (error != EWOULDBLOCK && !knows_no_locks) throw cannot(path, "locked", error);
    auto process = start_of_file(path, 64);
    process = process.empty() ? "" : fmt::format(", process {},", process.substr(0, process.find('\n')));
    if (error == EWOULDBLOCK)
        throw try_again("{}: another run{} is writing there; wait for it, or give another folder with --out",
                        folder_.string(), process);
    throw io_failed(
        "{}: another run{} may be writing there: the file system has no locks ({}); remove {} if no run is active, or "
        "give another folder with --out",
        folder_.string(), process, std::generic_category().message(error), hidden_.string());
}

/// Reads what an earlier run left in the hidden folder, and publishes the files that it had committed.
void Transaction::recover() {
    std::string text(std::size_t{1} << 16, '\0');
    const auto got = pread(fileno(lock_.get()), text.data(), text.size(), 0);
    if (got < 0) throw cannot(hidden(lock_name), "read");
    text.resize(static_cast<std::size_t>(got));
    std::istringstream notes(text);
    std::optional<std::set<ino_t>> fresh;
    for (std::string word; notes >> word;) {
        if (word == "part" && notes >> std::quoted(word)) used_.insert(word);
        if (word != "publish" || !std::getline(notes, word) || notes.eof()) continue;  // its line may be incomplete
        std::istringstream inodes(word);
        fresh.emplace(std::istream_iterator<ino_t>(inodes), std::istream_iterator<ino_t>());
    }
    if (!fresh) return;
    keeps_hidden_ = true;  // in case this fails
    auto names = names_in(hidden_);
    std::erase_if(names, [&](const std::string& name) {
        const bool is_older = fs::is_directory(hidden(name)) && !fresh->contains(inode_of(hidden(name)));
        return !used_.contains(name) || name == backup_name || is_older;
    });
    std::stable_partition(names.begin(), names.end(), [](const auto& name) { return !name.ends_with(".json"); });
    for (const auto& name : names) require(fs::is_directory(hidden(name)) ? name + "/" : name);
    for (const auto& name : names) move_in(name);
    sync_folder(folder_);
    written_ = written_files(folder_);
}

/// The path of a name in the hidden folder, recorded as the run's own.
fs::path Transaction::used(const std::string& name) {
    if (!used_.insert(name).second) return hidden(name);
    std::ostringstream note;
    note << "part " << std::quoted(name) << '\n';
    append(lock_, note.str(), hidden(lock_name));
    return hidden(name);
}

/// Whether a run made this file of the hidden folder.
bool Transaction::is_used(std::string_view name) const {
    if (used_.contains(name)) return true;
    return name.ends_with(kept_beside) && used_.contains(name.substr(0, name.size() - kept_beside.size()));
}

/// Removes what runs made in the hidden folder.
void Transaction::clear() const {
    for (const auto& name : names_in(hidden_))
        if (is_used(name)) remove_made(hidden(name));
}

/// Clears the hidden folder and marks it as this process's.
void Transaction::begin() {
    clear();
    if (ftruncate(fileno(lock_.get()), 0) != 0) throw cannot(hidden(lock_name), "written");
    used_.clear();
    keeps_hidden_ = false;
    append(lock_, fmt::format("{}\n", getpid()), hidden(lock_name));
}

void Transaction::require(const std::string& name) const {
    const bool is_folder = name.ends_with('/');
    const auto path = folder_ / (is_folder ? name.substr(0, name.size() - 1) : name);
    require_type(path, is_folder);
    if (type_of(path) == Type::not_found) return;
    if (!is_folder) return refuse_foreign_file(name);
    for (const auto& file : names_in(path)) {
        if (type_of(path / file) != Type::regular || (!is_numbered(file) && !written_.contains(name + file)))
            throw not_ours(path / file);
        refuse_foreign_file(name + file);
    }
}

void Transaction::refuse_foreign_file(const std::string& name) const {
    const auto path = folder_ / name;
    std::error_code error;
    for (const auto& input : replacing_.inputs)
        // compares the file itself: links and hard links are equivalent
        if (fs::equivalent(input, path, error) && !error)
            throw io_failed("{} is read by this run and would be replaced; give another folder with --out",
                            path.string());
    const auto origin = origin_of(folder_, name, written_);
    if (!origin.is_ours) throw not_ours(path);
    if (!replacing_.force && !origin.kind.empty() && !kind_.empty() && origin.kind != kind_)
        throw io_failed(
            "{} was made by a {}, and this is a {}; give another folder with --out, or replace it with --force",
            path.string(), origin.kind, kind_);
    if (!replacing_.force && origin.is_changed)
        throw io_failed(
            "{} was changed since Doppel wrote it; move it, give another folder with --out, or replace it "
            "with --force",
            path.string());
    // report now an immutable file (chattr +i), which cannot be renamed; a read-only file can be
    if (access(path.c_str(), W_OK) != 0 && errno == EPERM) throw cannot(path, "replaced");
}

fs::path Transaction::file(const std::string& name) {
    require(name);
    return used(parts_.emplace_back(Part{name}).name);
}

fs::path Transaction::directory(const std::string& name) {
    require(name + "/");
    const auto path = used(parts_.emplace_back(Part{name}).name);
    if (mkdir(path.c_str(), 0777) != 0) throw cannot(path, "made");
    return path;
}

void Transaction::remove(const std::string& name) {
    if (type_of(folder_ / name) != Type::regular) return;
    const auto origin = origin_of(folder_, name, written_);
    if (origin.is_ours && !origin.is_changed) removed_.push_back(name);
}

void Transaction::finished(const std::string& name) {
    for (Part& part : parts_) part.finished = part.finished || part.name == name;
}

std::vector<fs::path> Transaction::keeping_finished(const std::function<std::vector<fs::path>()>& last) {
    try {
        return last();
    } catch (const std::exception& error) {
        const auto* ours = dynamic_cast<const Error*>(&error);
        if (is_temporary() || (ours && ours->code() == ExitCode::interrupted)) throw;
        std::string kept;
        for (const Part& part : parts_)
            if (part.finished)
                kept += (kept.empty() ? "; what is finished stays until the next run: " : ", ") +
                        hidden(part.name).string();
        keeps_hidden_ = keeps_hidden_ || !kept.empty();
        throw Error(ours ? ours->code() : ExitCode::io_failed, error.what() + kept);
    }
}

void Transaction::keep_only(const std::string& name, const std::string& new_name) {
    require(new_name);
    for (const Part& part : parts_)
        if (part.name != name) remove_made(hidden(part.name));
    rename_file(hidden(name), used(new_name));
    parts_ = {{new_name, true}};
}

std::vector<std::pair<std::string, WrittenFile>> Transaction::finished_files() const {
    std::vector<std::pair<std::string, WrittenFile>> files;
    const auto add = [&](const std::string& name) {
        files.push_back({name, {fs::file_size(hidden(name)), sha256_of_file(hidden(name))}});
    };
    for (const auto& [name, finished] : parts_) {
        if (!finished) continue;
        if (!fs::is_directory(hidden(name)))
            add(name);
        else
            for (const auto& file : names_in(hidden(name))) add(name + "/" + file);
    }
    return files;
}

std::map<std::string, WrittenFile> Transaction::earlier_files() const {
    std::map<std::string, WrittenFile> earlier;
    for (const auto& [name, about] : written_) {
        const auto first = name.substr(0, name.find('/'));
        const bool is_of_run = std::ranges::find(parts_, first, &Part::name) != parts_.end() ||
                               std::ranges::find(removed_, first) != removed_.end();
        if (!is_of_run && type_of(folder_ / name) == Type::regular) earlier.emplace(name, about);
    }
    return earlier;
}

std::vector<fs::path> Transaction::publish() {
    std::vector<fs::path> files;
    std::string record = "publish";
    for (Part& part : parts_) {
        const auto path = hidden(part.name);
        if (type_of(path) == Type::not_found) throw cannot(path, "published", ENOENT);
        const bool is_folder = fs::is_directory(path);
        require(is_folder ? part.name + "/" : part.name);
        if (is_folder) {
            sync_folder(path, true);
            record += fmt::format(" {}", inode_of(path));
        } else {
            sync(fileno(open_file(path).get()), path);
        }
        part.finished = true;
        files.push_back(folder_ / part.name);
    }
    sync_folder(hidden_);
    append(lock_, record + "\n", hidden(lock_name));
    keeps_hidden_ = true;  // from here on the files are published, by this run or the next
    sync(fileno(lock_.get()), hidden(lock_name));
    for (; !parts_.empty(); parts_.erase(parts_.begin())) move_in(parts_.front().name);
    sync_folder(folder_);
    std::error_code ignored;
    for (const auto& name : std::exchange(removed_, {})) fs::remove(folder_ / name, ignored);
    try {
        begin();
    } catch (const Error&) {
        // everything is in place; the next run cleans up
    }
    made_.clear();  // the paths "new/../there" are valid only while "new" exists
    return files;
}

/// Moves the file to its place; an older folder moves into the hidden folder in exchange.
void Transaction::move_in(const std::string& name) {
    const auto from = hidden(name), to = folder_ / name;
    if (type_of(to) == Type::directory) {
        if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return;
        if (errno != EINVAL && errno != ENOSYS && errno != EOPNOTSUPP) throw cannot(from, "renamed to " + to.string());
        rename_file(to, used(backup_name));
    }
    rename_file(from, to);
}

}  // namespace doppel

#include "output/folder_lock.hpp"

#include "numeric/error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

namespace doppel {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) {
    return std::generic_category().message(error);
}

/// The lines of a lock file: the process, then the names.
std::vector<std::string> lines_of(const fs::path& path) {
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
}

/// Whether the open file is still the one of that name: its run removes it while another waits to open it.
bool is_current(int file, const fs::path& path) {
    struct stat open {
    }, named{};
    return fstat(file, &open) == 0 && stat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

/// The parts that a killed run had written down; whatever else its file says.
void remove_left(const fs::path& lock) {
    for (const auto& line : lines_of(lock)) {
        const fs::path name = line;
        if (name != name.filename() || name.extension() != ".part") continue;
        const auto part = lock.parent_path() / name;
        std::error_code error;
        fs::remove_all(part, error);
        if (error) throw io_failed("{}: a stale part cannot be removed: {}", part.string(), error.message());
    }
}

[[noreturn]] void refuse(const fs::path& path) {
    const auto lines = lines_of(path);
    throw io_failed("{}: another run{} is writing there; wait for it, or give another folder with --out",
                    path.parent_path().string(), lines.empty() ? "" : fmt::format(", process {},", lines.front()));
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, const std::string& run) : path_(folder / fmt::format(".{}.lock", run)) {
    for (;;) {
        file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        if (file_ < 0) throw io_failed("{}: cannot be written to: {}", folder.string(), reason(errno));
        const int fault = flock(file_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        // some network file systems know no locks: there two runs at once are on their own
        const bool held = fault == 0 || fault == ENOLCK || fault == EOPNOTSUPP || fault == ENOSYS;
        if (held && is_current(file_, path_)) break;
        close(file_);
        file_ = -1;
        if (fault == EWOULDBLOCK) refuse(path_);
        if (!held) throw io_failed("{}: cannot be locked: {}", path_.string(), reason(fault));
    }
    try {
        remove_left(path_);
        if (ftruncate(file_, 0) != 0) throw io_failed("{}: cannot be written: {}", path_.string(), reason(errno));
        note(std::to_string(getpid()));
    } catch (...) {
        close(file_);
        throw;
    }
}

FolderLock::~FolderLock() {
    unlink(path_.c_str());  // before the lock goes: it can be nobody else's
    close(file_);
}

void FolderLock::note(const std::string& part) {
    const auto text = part + "\n";
    const auto written = write(file_, text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size()))
        throw io_failed("{}: cannot be written: {}", path_.string(), reason(written < 0 ? errno : ENOSPC));
}

}  // namespace doppel

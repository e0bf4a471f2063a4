#include "output/journal.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <string_view>
#include <utility>

namespace doppel {
namespace {

using Kind = Entry::Kind;

constexpr std::string_view head = "doppel run, process ";  // PID on HOST

std::string host() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

std::string first_line() {
    return fmt::format("{}{} on {}", head, getpid(), host());
}

/// Whether the process that a lock file's first line names has certainly ended (only known for this machine).
bool is_gone(std::string_view line) {
    pid_t process = 0;
    const char* const end = line.data() + line.size();
    const auto [rest, fault] = std::from_chars(line.data() + head.size(), end, process);
    return fault == std::errc() && process > 0 && std::string_view(rest, end) == " on " + host() &&
           kill(process, 0) != 0 && errno == ESRCH;
}

/// A note as a line, and back: no name has a '/', which stands for a line break in one.
std::string as_line(std::string note) {
    std::ranges::replace(note, '\n', '/');
    return note + "\n";
}
std::string name_in(std::string_view line) {
    std::string name(line);
    std::ranges::replace(name, '/', '\n');
    return name;
}

/// Others in a lock file are ignored.
bool is_name(std::string_view name) {
    return !name.empty() && name != "." && name != "..";
}

}  // namespace

std::string part_name(const std::string& name) {
    return name + ".part";
}

std::string aside_name(const std::string& name) {
    return name + ".old.part";
}

bool is_waiting(const Folder& folder, const Publication::Step& step) {
    const Entry part = folder.entry(part_name(step.name));
    return part.kind != Kind::none && part.inode == step.inode;
}

void put_in_place(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) {
        const auto part = part_name(step.name);
        if (!is_waiting(folder, step)) continue;
        const bool is_new = folder.entry(step.name).kind == Kind::none;
        if (!is_new && folder.exchange(part, step.name)) continue;
        if (!is_new) folder.rename(step.name, aside_name(step.name));
        folder.rename(part, step.name);
    }
    folder.sync();
}

void take_back(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) {
        const auto part = part_name(step.name), aside = aside_name(step.name);
        const Entry placed = folder.entry(step.name);
        if (placed.kind != Kind::none && placed.inode == step.inode) {
            if (folder.entry(part).kind != Kind::none) {
                folder.exchange(part, step.name);
                continue;
            }
            folder.rename(step.name, part);
        }
        if (folder.entry(aside).kind != Kind::none && folder.entry(step.name).kind == Kind::none)
            folder.rename(aside, step.name);
    }
    folder.sync();
}

void clear_away(const Folder& folder, const Publication& publication) {
    for (const auto& step : publication.steps) {
        folder.remove(part_name(step.name));
        folder.remove(aside_name(step.name));
    }
    if (publication.state == Publication::State::publish)
        for (const auto& name : publication.removed) folder.remove(name);
}

Journal::Journal(const Folder& folder, const std::string& run) : folder_(folder), name_(fmt::format(".{}.lock", run)) {
    take();
    if (!left_.empty()) left_.erase(left_.begin());  // its process
}

/// Opens, locks and reads the file; starts again where its owner has meanwhile removed it.
void Journal::take() {
    const auto path = folder_.path() / name_;
    for (;;) {
        constexpr int flags = O_RDWR | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
        file_ = Descriptor(openat(folder_.descriptor(), name_.c_str(), flags | O_CREAT | O_EXCL, 0666));
        const bool is_new = bool(file_);
        if (!is_new && errno == EEXIST) file_ = Descriptor(openat(folder_.descriptor(), name_.c_str(), flags));
        if (!file_ && errno == ENOENT && folder_.entry(".").names > 0) continue;  // removed meanwhile
        if (!file_ && errno == ELOOP)
            throw io_failed("{} is a symbolic link; Doppel follows none there", path.string());
        if (!file_) throw cannot(folder_.path(), "written to");
        struct stat status {};
        if (fstat(file_.number(), &status) != 0) throw cannot(path, "read");
        if (!S_ISREG(status.st_mode) || status.st_nlink > 1)
            throw io_failed("{} is no lock file of Doppel's; remove it", path.string());
        const int fault = flock(file_.number(), LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        if (fault == EINTR) continue;
        const bool knows_no_locks = fault == ENOLCK || fault == EOPNOTSUPP || fault == ENOSYS;
        if (fault != 0 && fault != EWOULDBLOCK && !knows_no_locks) throw cannot(path, "locked", fault);
        if (fault == 0 && folder_.entry(name_).inode != status.st_ino) continue;
        read_notes();
        // "process 123", without its host
        const auto process = left_.empty() ? "" : left_.front().substr(head.find("process"));
        const auto holder = process.empty() ? "" : fmt::format(", {},", process.substr(0, process.find(" on ")));
        if (fault == EWOULDBLOCK)
            throw io_failed("{}: another run{} is writing there; wait for it, or give another folder with --out",
                            folder_.path().string(), holder);
        if (knows_no_locks && !is_new && (left_.empty() || !is_gone(left_.front())))
            throw io_failed(
                "{}: another run{} may be writing there: the file system has no locks ({}), so nobody can tell; remove "
                "{} if there is none, or give another folder with --out",
                folder_.path().string(), holder, std::generic_category().message(fault), name_);
        return;
    }
}

void Journal::read_notes() {
    left_.clear();
    std::string text;
    char block[4096];
    for (ssize_t n = 0; (n = pread(file_.number(), block, sizeof block, static_cast<off_t>(text.size()))) > 0;)
        text.append(block, static_cast<std::size_t>(n));
    if (!text.empty() && !std::string_view(text).starts_with(std::string_view(head).substr(0, text.size())))
        throw io_failed("{} is no lock file of Doppel's; remove it", (folder_.path() / name_).string());
    // a last line without an end was cut off
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        left_.push_back(text.substr(at, end - at));
}

Journal::~Journal() {
    // before the lock is released, so that no other run owns it yet
    if (!leaves_) unlinkat(folder_.descriptor(), name_.c_str(), 0);
}

void Journal::begin() {
    if (ftruncate(file_.number(), 0) != 0) throw cannot(folder_.path() / name_, "written");
    left_.clear();
    note(first_line());
}

void Journal::note(const std::string& line, bool synced) {
    const auto text = as_line(line);
    const auto written = write(file_.number(), text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size()))
        throw cannot(folder_.path() / name_, "written", written < 0 ? errno : ENOSPC);
    if (synced && fsync(file_.number()) != 0 && errno != EINVAL) throw cannot(folder_.path() / name_, "written");
}

Publication Journal::left() const {
    Publication publication;
    for (const std::string_view line : left_) {
        const auto space = line.find(' ');
        const auto word = line.substr(0, space), rest = space == line.npos ? "" : line.substr(space + 1);
        if (word == "publish") publication.state = Publication::State::publish;
        if (word == "withdraw") publication.state = Publication::State::withdraw;
        if (word == "withdrawn") publication = {.parts = std::move(publication.parts)};
        if (word == "part" && is_name(rest)) publication.parts.push_back(name_in(rest));
        if (word == "remove" && is_name(rest)) publication.removed.push_back(name_in(rest));
        if (word == "place") {
            ino_t inode = 0;
            const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), inode);
            const auto name = rest.substr(std::min<std::size_t>(rest.size(), std::size_t(end - rest.data()) + 1));
            if (fault == std::errc() && is_name(name)) publication.steps.push_back({name_in(name), inode});
        }
    }
    return publication;
}

}  // namespace doppel

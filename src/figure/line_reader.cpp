#include "figure/line_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace doppel {
namespace {

std::string reason(int error) {
    return std::generic_category().message(error);
}

}  // namespace

LineReader::LineReader(std::filesystem::path path, std::string remedy)
    : path_(std::move(path)), remedy_(std::move(remedy)) {
    file_ = open(path_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file_ < 0) throw fault(errno == ELOOP ? "is a symbolic link" : reason(errno));
    struct stat status {};
    if (fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) return;
    close(file_);
    throw fault("is no regular file");
}

LineReader::~LineReader() {
    close(file_);
}

bool LineReader::next(std::string& line, std::size_t most) {
    for (std::size_t searched = at_;;) {
        const auto end = unread_.find('\n', searched);
        if (end != std::string::npos) {
            line.assign(unread_, at_, end - at_);
            at_ = end + 1;
            return line.size() <= most;
        }
        if (unread_.size() - at_ > most) return false;
        searched = unread_.size() - at_;
        unread_.erase(0, at_);
        at_ = 0;
        if (!read_more()) return false;
    }
}

bool LineReader::read_more() {
    constexpr std::size_t block = 1 << 16;
    const auto before = unread_.size();
    unread_.resize(before + block);
    ssize_t got = 0;
    do got = read(file_, unread_.data() + before, block);
    while (got < 0 && errno == EINTR);
    if (got < 0) throw fault("cannot be read: " + reason(errno));
    unread_.resize(before + static_cast<std::size_t>(got));
    return got > 0;
}

Error LineReader::fault(const std::string& why) const {
    return io_failed("{}: {}; {}", path_.string(), why, remedy_);
}

}  // namespace doppel

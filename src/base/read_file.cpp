#include "base/read_file.hpp"

#include "base/error.hpp"
#include "base/owned.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace doppel {
namespace {

/// Waits until bytes can be read. Throws Error (exit 130) soon after `stop` is set.
void wait_for_bytes(int pipe, const std::atomic<bool>& stop) {
    constexpr int patience_ms = 50;
    pollfd wanted{.fd = pipe, .events = POLLIN, .revents = 0};
    while (!stop)
        if (poll(&wanted, 1, patience_ms) > 0) return;
    throw interrupted();
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& path, const WantedFile& wanted,
                            const std::atomic<bool>* stop) {
    const auto reason = [] { return std::generic_category().message(errno); };
    if (path.native().find('\0') != std::string::npos)  // the system would open the path up to the NUL
        throw bad_input("{}: contains a NUL character; a file name cannot", path.string());
    const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    const Owned<std::FILE, std::fclose> owner(file < 0 ? nullptr : fdopen(file, "r"));
    if (!owner) throw bad_input("{}: {}", path.string(), errno == ENOENT ? std::string(wanted.missing) : reason());
    struct stat status {};
    if (fstat(file, &status) != 0) throw io_failed("{}: cannot be read: {}", path.string(), reason());
    if (S_ISDIR(status.st_mode)) throw bad_input("{} is a folder; {}", path.string(), wanted.what);
    const bool is_pipe = S_ISFIFO(status.st_mode) && stop;
    if (!S_ISREG(status.st_mode) && !is_pipe) throw bad_input("{} is not a file; {}", path.string(), wanted.what);
    const auto bound = [&](std::size_t bytes) {
        if (bytes > wanted.max_bytes)
            throw bad_input("{} has more than {} MB; {}", path.string(), wanted.max_bytes >> 20, wanted.what);
    };
    bound(static_cast<std::size_t>(status.st_size));
    std::string text, portion(std::size_t{1} << 16, '\0');
    for (;;) {
        if (is_pipe) wait_for_bytes(file, *stop);
        const auto count = read(file, portion.data(), portion.size());
        if (count == 0) return text;
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (count < 0) throw io_failed("{}: cannot be read: {}", path.string(), reason());
        text.append(portion, 0, static_cast<std::size_t>(count));
        bound(text.size());
    }
}

}  // namespace doppel

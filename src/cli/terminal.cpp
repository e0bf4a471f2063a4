#include "cli/terminal.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>

namespace doppel {
namespace {

// a signal can reach nothing but what is global; only this file sees it
std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& watch_interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_requested = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // the terminal closes; nohup's wish to go on counts
    struct sigaction before {};
    if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
    return stop_requested;
}

void outlive_readers() {
    std::signal(SIGPIPE, SIG_IGN);
}

std::error_code try_write_out(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return {};
    return {errno, std::generic_category()};
}

void write_out(std::string_view text) {
    if (const auto fault = try_write_out(text)) throw unwritten(fault);
}

Error unwritten(const std::error_code& why) {
    return io_failed("standard output cannot be written: {}", why.message());
}

}  // namespace doppel

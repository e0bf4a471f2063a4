#include "cli/interrupt.hpp"

#include <csignal>

namespace doppel {
namespace {

// a signal can reach nothing but what is global; only this file sees it
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& watch_interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = true; };
    action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // the terminal closes; nohup's wish to go on counts
    struct sigaction before {};
    if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
    return interrupted;
}

void outlive_readers() {
    std::signal(SIGPIPE, SIG_IGN);
}

}  // namespace doppel

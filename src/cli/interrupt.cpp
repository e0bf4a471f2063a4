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
    // a file over the size limit is an error to report, not a reason to die
    std::signal(SIGXFSZ, SIG_IGN);
    return interrupted;
}

}  // namespace doppel

#pragma once

#include <atomic>

namespace doppel {

/// Becomes true when the person, or the system, asks the program to end (SIGINT, SIGTERM, SIGHUP). The second time ends
/// it at once.
const std::atomic<bool>& watch_interrupts();

/// From now on, whoever reads the progress may go away, and the work goes on.
void outlive_readers();

}  // namespace doppel

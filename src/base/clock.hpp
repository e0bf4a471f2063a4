#pragma once

#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>

namespace doppel {

/// What a clock of the system shows, s: CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID, CLOCK_THREAD_CPUTIME_ID.
inline double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Ends what takes a `stop`, after some seconds or soon after another `stop` is set.
class TimeLimit {
public:
    TimeLimit(double seconds, const std::atomic<bool>& other)
        : watch_([this, &other, end = seconds_of(CLOCK_MONOTONIC) + seconds](const std::stop_token& quit) {
              while (!quit.stop_requested() && !other && seconds_of(CLOCK_MONOTONIC) < end)
                  std::this_thread::sleep_for(std::chrono::milliseconds(5));
              reached_ = true;
          }) {}

    const std::atomic<bool>& reached() const { return reached_; }

private:
    std::atomic<bool> reached_ = false;
    std::jthread watch_;  // last: joined before the rest goes
};

}  // namespace doppel

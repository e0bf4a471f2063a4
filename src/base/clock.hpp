#pragma once

#include <atomic>
#include <chrono>
#include <ctime>
#include <thread>

namespace doppel {

/// The time of a system clock, s: CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID or CLOCK_THREAD_CPUTIME_ID.
inline double seconds_of(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Sets its own stop flag after some seconds, or soon after another `stop` is set.
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
    std::jthread watch_;  // declared last: joined before the other members are destroyed
};

}  // namespace doppel

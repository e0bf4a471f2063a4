#pragma once

#include "base/error.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <latch>
#include <mutex>
#include <thread>
#include <vector>

namespace doppel {

/// Starts up to `count` threads that call work(). Returns fewer, possibly none, if the system allows no more.
template <class Work>
std::vector<std::jthread> start_threads(std::size_t count, const Work& work) {
    std::vector<std::jthread> threads;
    threads.reserve(count);
    try {
        while (threads.size() < count) threads.emplace_back(work);
    } catch (const std::exception&) {  // no more threads, or no memory for them
    }
    return threads;
}

/// The error for a thread that is needed and cannot be started.
inline Error no_thread() {
    return io_failed(
        "the system allows this process no more threads: raise its limits of processes (ulimit -u, pids.max of its "
        "control group) or of memory (ulimit -v, -d), or end other programs");
}

/// Throws Error (exit 4) if this process may not start `count` further threads. Called before libraries that hang or
/// abort when one of their threads cannot be started.
inline void need_threads(std::size_t count) {
    std::latch all_there(1);
    const auto threads = start_threads(count, [&] { all_there.wait(); });
    all_there.count_down();
    if (threads.size() < count) throw no_thread();
}

/// Calls work(i) once for each i = 0 … count − 1, on up to `jobs` threads including the calling one. Each thread takes
/// the next free i. The first error stops all threads and is rethrown here.
template <class Work>
void parallel_for(std::size_t count, int jobs, Work&& work) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr error;
    std::mutex error_mutex;
    const auto run = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        } catch (...) {
            const std::lock_guard lock(error_mutex);
            if (!error) error = std::current_exception();
            next = count;
        }
    };
    {
        const auto helpers = std::min(static_cast<std::size_t>(std::max(jobs, 1)), count) - (count > 0 ? 1 : 0);
        const auto threads = start_threads(helpers, run);  // joined at the end of this block
        run();
    }
    if (error) std::rethrow_exception(error);
}

/// Sets its own stop flag after some seconds, or soon after another `stop` is set.
class TimeLimit {
public:
    TimeLimit(double seconds, const std::atomic<bool>& other)
        : watch_([this, &other, end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds)](
                     const std::stop_token& quit) {
              while (!quit.stop_requested() && !other && std::chrono::steady_clock::now() < end)
                  std::this_thread::sleep_for(std::chrono::milliseconds(5));
              reached_ = true;
          }) {}

    const std::atomic<bool>& reached() const { return reached_; }

private:
    std::atomic<bool> reached_ = false;
    std::jthread watch_;  // declared last: joined before the other members are destroyed
};

}  // namespace doppel

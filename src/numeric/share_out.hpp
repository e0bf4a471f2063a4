#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace doppel {

/// As many threads as this process may use cores at once, at least one.
inline int cores() {
    return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Calls work(i) once for each i = 0 … count − 1, on `jobs` threads (this one among them): whoever is free takes the
/// next. The first error stops them all and is thrown here.
template <class Work>
void share_out(std::size_t count, int jobs, Work&& work) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr error;
    std::mutex error_mutex;
    const auto run = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        } catch (...) {
            const std::lock_guard hold(error_mutex);
            if (!error) error = std::current_exception();
            next = count;
        }
    };
    {
        std::vector<std::jthread> threads;
        const auto helpers = std::min(static_cast<std::size_t>(std::max(jobs, 1)), count) - (count > 0 ? 1 : 0);
        for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(run);
        run();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace doppel

#pragma once

#include "base/threads.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>

namespace doppel {

/// Calls work(i) once for each i = 0 … count − 1, on `jobs` threads (this one among them), or as many as there are to
/// be had: whoever is free takes the next. The first error stops them all and is thrown here.
template <class Work>
void parallel_for(std::size_t count, int jobs, Work&& work) {
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
        const auto helpers = std::min(static_cast<std::size_t>(std::max(jobs, 1)), count) - (count > 0 ? 1 : 0);
        const auto threads = start_threads(helpers, run);  // they end where this block does
        run();
    }
    if (error) std::rethrow_exception(error);
}

}  // namespace doppel

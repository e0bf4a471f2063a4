#pragma once

#include "base/threads.hpp"
#include "output/queue.hpp"

#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace doppel {

/// Threads that do a piece of work each time they are given something, first come first served. The first error of any
/// of them stops them all and is thrown to whoever gives or finishes. Destroyed unfinished, they drop what waits for
/// them.
template <class T>
class Workers {
public:
    /// `threads` of them, or as many as there are to be had; throws Error (exit 4) where there is none. At most
    /// `waiting` things wait; then give() does.
    Workers(std::size_t threads, std::size_t waiting, std::function<void(T&)> work)
        : queue_(waiting), work_(std::move(work)), threads_(start_threads(threads, [this] { run(); })) {
        if (threads_.empty()) throw no_thread();
    }
    ~Workers() { queue_.abandon(); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void give(T thing) {
        if (!queue_.push(std::move(thing))) std::rethrow_exception(error_);
    }

    /// Waits until all that was given is done.
    void finish() {
        queue_.close();
        threads_.clear();
        if (error_) std::rethrow_exception(error_);
    }

private:
    void run() {
        try {
            while (std::optional<T> thing = queue_.pop()) work_(*thing);
        } catch (...) {
            std::call_once(failed_, [this] {
                error_ = std::current_exception();
                queue_.abandon();
            });
        }
    }

    Queue<T> queue_;
    std::function<void(T&)> work_;
    std::once_flag failed_;
    std::exception_ptr error_;
    std::vector<std::jthread> threads_;  // last: joined before the rest goes
};

}  // namespace doppel

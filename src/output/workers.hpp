#pragma once

#include "base/threads.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace doppel {

/// Hands things from one thread to another, a bounded number at a time: the faster side waits for the slower.
template <class T>
class Queue {
public:
    explicit Queue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits for room. False where the queue was closed: the thing was not taken.
    bool push(T thing) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return closed_ || things_.size() < capacity_; });
        if (closed_) return false;
        things_.push_back(std::move(thing));
        filled_.notify_one();
        return true;
    }

    /// Waits for the next thing. Nothing where the queue is closed and empty.
    std::optional<T> pop() {
        std::unique_lock lock(mutex_);
        filled_.wait(lock, [&] { return closed_ || !things_.empty(); });
        if (things_.empty()) return std::nullopt;
        std::optional<T> thing(std::move(things_.front()));
        things_.pop_front();
        room_.notify_one();
        return thing;
    }

    /// No more will come; what is in it can still be taken.
    void close() {
        std::lock_guard lock(mutex_);
        closed_ = true;
        room_.notify_all();
        filled_.notify_all();
    }

    /// Closes, and forgets what is in it.
    void abandon() {
        close();
        std::lock_guard lock(mutex_);
        things_.clear();
    }

private:
    const std::size_t capacity_;
    std::mutex mutex_;
    std::condition_variable room_, filled_;
    std::deque<T> things_;
    bool closed_ = false;
};

/// Things that are used again, with the memory they have: one thread takes, others give back.
template <class T>
class Pool {
public:
    /// One that was given back, or a new one.
    T take() {
        const std::lock_guard hold(mutex_);
        if (free_.empty()) return {};
        T thing = std::move(free_.back());
        free_.pop_back();
        return thing;
    }

    void give_back(T thing) {
        const std::lock_guard hold(mutex_);
        free_.push_back(std::move(thing));
    }

private:
    std::mutex mutex_;
    std::vector<T> free_;
};

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

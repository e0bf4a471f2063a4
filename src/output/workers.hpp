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

/// A bounded queue between threads (monitor: mutex and condition variables).
template <class T>
class Queue {
public:
    explicit Queue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits for room. Returns false, and pushes nothing, if the queue is closed.
    bool push(T thing) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return closed_ || things_.size() < capacity_; });
        if (closed_) return false;
        things_.push_back(std::move(thing));
        filled_.notify_one();
        return true;
    }

    /// Waits for an element. Returns nothing if the queue is closed and empty.
    std::optional<T> pop() {
        std::unique_lock lock(mutex_);
        filled_.wait(lock, [&] { return closed_ || !things_.empty(); });
        if (things_.empty()) return std::nullopt;
        std::optional<T> thing(std::move(things_.front()));
        things_.pop_front();
        room_.notify_one();
        return thing;
    }

    /// Nothing can be pushed any more; queued elements can still be popped.
    void close() {
        std::lock_guard lock(mutex_);
        closed_ = true;
        room_.notify_all();
        filled_.notify_all();
    }

    /// Closes the queue and discards its elements.
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

/// A thread pool that calls work() for each object given, in order of arrival. The first exception stops all threads
/// and is rethrown by give() or finish(). Destroyed unfinished, it discards what is queued.
template <class T>
class Workers {
public:
    /// `threads`, or as many as the system allows; throws Error (exit 4) if it allows none. give() blocks while
    /// `waiting` objects are queued.
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

    /// An object whose work is done, to reuse its memory, or a new one.
    T spare() {
        const std::lock_guard lock(done_mutex_);
        if (done_.empty()) return {};
        T thing = std::move(done_.back());
        done_.pop_back();
        return thing;
    }

    /// Waits until all work is done.
    void finish() {
        queue_.close();
        threads_.clear();
        if (error_) std::rethrow_exception(error_);
    }

private:
    void run() {
        try {
            while (std::optional<T> thing = queue_.pop()) {
                work_(*thing);
                const std::lock_guard lock(done_mutex_);
                done_.push_back(std::move(*thing));
            }
        } catch (...) {
            std::call_once(failed_, [this] {
                error_ = std::current_exception();
                queue_.abandon();
            });
        }
    }

    Queue<T> queue_;
    std::function<void(T&)> work_;
    std::mutex done_mutex_;
    std::vector<T> done_;
    std::once_flag failed_;
    std::exception_ptr error_;
    std::vector<std::jthread> threads_;  // declared last: joined before the other members are destroyed
};

}  // namespace doppel

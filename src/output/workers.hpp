#pragma once

#include "base/threads.hpp"

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace doppel {

/// A thread pool with a bounded queue. It calls work() for each object given, in order of arrival. The first exception
/// stops all threads and is rethrown by give() or finish(). Destroyed unfinished, it discards what is queued.
template <class T>
class Workers {
public:
    /// `threads`, or as many as the system allows; throws Error (exit 4) if it allows none. give() blocks while
    /// `waiting` objects are queued.
    Workers(std::size_t threads, std::size_t waiting, std::function<void(T&)> work)
        : waiting_(waiting), work_(std::move(work)), threads_(start_threads(threads, [this] { run(); })) {
        if (threads_.empty()) throw no_thread();
    }
    ~Workers() { close(true); }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    void give(T thing) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return error_ || queue_.size() < waiting_; });
        if (error_) std::rethrow_exception(error_);
        queue_.push_back(std::move(thing));
        filled_.notify_one();
    }

    /// An object whose work is done, to reuse its memory, or a new one.
    T spare() {
        const std::lock_guard lock(mutex_);
        if (done_.empty()) return {};
        T thing = std::move(done_.back());
        done_.pop_back();
        return thing;
    }

    /// Waits until all work is done.
    void finish() {
        close(false);
        threads_.clear();
        if (error_) std::rethrow_exception(error_);
    }

private:
    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            filled_.wait(lock, [&] { return closed_ || !queue_.empty(); });
            if (queue_.empty()) return;
            T thing = std::move(queue_.front());
            queue_.pop_front();
            room_.notify_one();
            lock.unlock();
            try {
                work_(thing);
            } catch (...) {
                return close(true, std::current_exception());
            }
            lock.lock();
            done_.push_back(std::move(thing));
        }
    }

    /// Nothing more is given; threads end when the queue is empty, or at once if it is discarded.
    void close(bool discards, const std::exception_ptr& error = nullptr) {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        if (discards) queue_.clear();
        if (!error_) error_ = error;
        room_.notify_all();
        filled_.notify_all();
    }

    const std::size_t waiting_;
    const std::function<void(T&)> work_;
    std::mutex mutex_;  // of all that follows
    std::condition_variable room_, filled_;
    std::deque<T> queue_;
    std::vector<T> done_;
    bool closed_ = false;
    std::exception_ptr error_;
    std::vector<std::jthread> threads_;  // declared last: joined before the other members are destroyed
};

}  // namespace doppel

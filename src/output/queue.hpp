#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

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

}  // namespace doppel

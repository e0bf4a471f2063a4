#pragma once

#include <mutex>
#include <utility>
#include <vector>

namespace doppel {

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

}  // namespace doppel

#include "output/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace doppel::queue_test {

using namespace std::chrono_literals;

TEST(Queue, KeepsOrderAndBound) {
    Queue<int> queue(4);
    std::atomic<int> pushed = 0, popped = 0, maximum = 0;
    std::jthread giver([&] {
        for (int k = 0; k < 20'000; ++k) {
            queue.push(k);
            // pushed - popped is at least the queue's length and at most one more, for a pop not yet counted
            maximum = std::max(maximum.load(), ++pushed - popped.load());
        }
        queue.close();
    });
    int expected = 0;
    while (const auto k = queue.pop()) {
        ASSERT_EQ(*k, expected++);
        ++popped;
    }
    EXPECT_EQ(expected, 20'000);
    EXPECT_LE(maximum, 5);
    EXPECT_GE(maximum, 1);
}

TEST(Queue, CloseWakesProducersAndConsumers) {
    Queue<int> full(1), empty(1);
    full.push(1);
    std::atomic<bool> refused = false, ended = false;
    {
        std::jthread giver([&] { refused = !full.push(2); });
        std::jthread taker([&] { ended = !empty.pop(); });
        std::this_thread::sleep_for(20ms);
        EXPECT_FALSE(refused || ended);  // both wait
        full.close();
        empty.close();
    }
    EXPECT_TRUE(refused && ended);
    EXPECT_EQ(full.pop(), 1);  // remaining items can still be popped
    EXPECT_EQ(full.pop(), std::nullopt);
}

TEST(Queue, AbandonDiscardsElements) {
    Queue<int> queue(2);
    queue.push(1);
    queue.abandon();
    EXPECT_EQ(queue.pop(), std::nullopt);
    EXPECT_FALSE(queue.push(2));
}

TEST(Workers, DoAllThatWasGiven) {
    std::atomic<long> sum = 0;
    Workers<int> workers(3, 2, [&](int k) { sum += k; });
    for (int k = 1; k <= 1000; ++k) workers.give(k);
    workers.finish();
    EXPECT_EQ(sum, 1000 * 1001 / 2);
}

TEST(Workers, OneErrorStopsAllAndIsRethrown) {
    std::atomic<int> done = 0;
    Workers<int> workers(3, 2, [&](int k) {
        if (k == 10) throw std::runtime_error("ten");
        ++done;
    });
    EXPECT_THROW(for (int k = 0; k < 1'000'000; ++k) workers.give(k), std::runtime_error);
    EXPECT_LT(done, 1'000'000);
    EXPECT_THROW(workers.finish(), std::runtime_error);
}

TEST(Workers, DestroyedTheyDiscardTheQueue) {
    std::atomic<int> done = 0;
    {
        Workers<int> workers(1, 8, [&](int) {
            ++done;
            std::this_thread::sleep_for(50ms);
        });
        for (int k = 0; k < 9; ++k) workers.give(k);
    }
    EXPECT_LE(done, 2);
}

}  // namespace doppel::queue_test

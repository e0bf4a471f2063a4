#include "output/workers.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

namespace doppel::queue_test {

using namespace std::chrono_literals;

TEST(Workers, KeepOrderAndBound) {
    std::atomic<int> given = 0, taken = 0, maximum = 0;
    int expected = 0;
    {
        Workers<int> workers(1, 4, [&](int k) {
            ++taken;
            EXPECT_EQ(k, expected++);
        });
        for (int k = 0; k < 20'000; ++k) {
            workers.give(k);
            // given - taken is at least the queue's length and at most one more, for one that is not yet counted
            maximum = std::max(maximum.load(), ++given - taken.load());
        }
        workers.finish();
    }
    EXPECT_EQ(expected, 20'000);
    EXPECT_LE(maximum, 5);
    EXPECT_GE(maximum, 1);
}

TEST(Workers, AnErrorWakesWhoeverWaitsForRoom) {
    std::atomic<bool> fails = false, refused = false;
    Workers<int> workers(1, 1, [&](int) {
        while (!fails) std::this_thread::sleep_for(1ms);
        throw std::runtime_error("failed");
    });
    workers.give(1);
    {
        std::jthread giver([&] {
            workers.give(2);
            try {
                workers.give(3);
            } catch (const std::runtime_error&) {
                refused = true;
            }
        });
        std::this_thread::sleep_for(20ms);
        EXPECT_FALSE(refused);  // waits
        fails = true;
    }
    EXPECT_TRUE(refused);
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

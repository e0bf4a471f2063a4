#include "base/threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace doppel::threads_test {

TEST(Threads, AreAsManyAsRequested) {
    std::atomic<int> ran = 0;
    {
        const auto threads = start_threads(5, [&] { ++ran; });
        EXPECT_EQ(threads.size(), 5u);
    }
    EXPECT_EQ(ran, 5);
    EXPECT_NO_THROW(need_threads(20));
}

TEST(ShareOut, DoesEachPieceOnce) {
    for (const int jobs : {0, 1, 3, 50}) {
        std::vector<std::atomic<int>> done(40);
        parallel_for(done.size(), jobs, [&](std::size_t i) { ++done[i]; });
        for (const auto& times : done) EXPECT_EQ(times, 1) << jobs;
    }
    parallel_for(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ShareOut, ThrowsTheFirstErrorAndStops) {
    std::atomic<int> done = 0;
    const auto work = [&](std::size_t i) {
        if (i == 5) throw std::runtime_error("five");
        ++done;
    };
    EXPECT_THROW(parallel_for(1'000'000, 3, work), std::runtime_error);
    EXPECT_LT(done, 1'000'000);
}

}  // namespace doppel::threads_test

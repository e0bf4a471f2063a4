#include "base/threads.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
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

#ifndef DOPPEL_SANITIZE  // the sanitizer needs terabytes of address space
TEST(Threads, NameTheLimitThatKeepsThemFromStarting) {
    // a separate process with less address space than a stack
    const auto end_within = [](decltype(RLIMIT_AS) limited) {
        std::ifstream sizes("/proc/self/statm");
        rlim_t pages = 0;
        sizes >> pages;
        const rlim_t maximum = limited == RLIMIT_NPROC ? 0 : pages * 4096 + (rlim_t{4} << 20);
        const rlimit limit{maximum, maximum};
        setrlimit(limited, &limit);
        std::fputs(no_thread().what(), stderr);
        std::_Exit(0);
    };
    const testing::ExitedWithCode told(0);
    EXPECT_EXIT(end_within(RLIMIT_AS), told, "no memory for its stack; .* \\(ulimit -v\\)$");
    EXPECT_EXIT(end_within(RLIMIT_NPROC), told, "no more threads; raise its limit \\(ulimit -u, ");
}
#endif

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

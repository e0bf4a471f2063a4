// The system allows the program only a few threads, or none.
#include "cli/process.hpp"

#include <fmt/ranges.h>

namespace doppel::few_threads_test {

using namespace test;

/// The program's exit code if it may start at most `count` threads.
int code_with_threads(int count, const Words& line) {
    const auto prepare = [&] {
        setenv("LD_PRELOAD", DOPPEL_FEW_THREADS, 1);
        setenv("DOPPEL_TEST_THREADS", std::to_string(count).c_str(), 1);
        setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
    };
    return wait_at_most(start(line, prepare),
                        60);  // s; measured 0.3, and infinite if the program waits for a thread that did not start
}

TEST(FewThreads, AreEnoughOrReportedWithoutLeavingFiles) {
    const auto film = [](const Words& more) {
        return with("render butterfly --size 128x72 --set scene.duration_s=0.2 --frames 0:5 --progress none", more);
    };
    const std::vector<Words> lines{
        film({}),
        film("--format png --jobs 3"),
        film("--format gif"),
        film("--format apng"),
        film("--format webm"),
        film("--format webm --set video.codec=\"av1\""),
        film("--format webm --set video.codec=\"av1\" --set video.pixel_format=\"yuv444p\""),
        "simulate butterfly --set scene.duration_s=0.1 --progress none",
        "figure fig2-right --set grid.x.step=30 --jobs 4 --progress none",
    };
    for (const auto& line : lines)
        for (const int count : {0, 1, 4, 12, 1000}) {
            const auto what = fmt::format("{} threads: {}", count, fmt::join(line, " "));
            const auto folder = fresh_folder();
            const int code = code_with_threads(count, line);
            const auto message = bytes_of(folder / "stderr");
            if (code == 0) {
                EXPECT_TRUE(count > 0 || line[0] == "simulate" || line[0] == "figure") << what;
                EXPECT_EQ(message, "") << what;
                continue;
            }
            EXPECT_EQ(code, 4) << what << "\n" << message;
            EXPECT_TRUE(one_line(message)) << what << "\n" << message;
            EXPECT_TRUE(has(message, "no more threads")) << what << "\n";
            EXPECT_TRUE(left_nothing()) << what;
            EXPECT_LT(count, 1000) << what;
        }
}

// x264 read what its memory held before, in narrow pictures.
TEST(Memory, WhateverItHoldsAFilmHasTheSameBytes) {
    std::string first;
    for (const char* fill : {"0", "85", "170"}) {
        const auto folder = fresh_folder();
        const auto film = start(
            "render butterfly --size 96x96 --set scene.duration_s=2 --set video.fps=12 --set "
            "video.preset=medium --progress none",
            [&] { setenv("MALLOC_PERTURB_", fill, 1); });
        ASSERT_EQ(wait_for(film), 0) << bytes_of(folder / "stderr");
        const auto bytes = bytes_of(folder / "out/butterfly/butterfly.mp4");
        if (first.empty()) first = bytes;
        EXPECT_TRUE(bytes == first) << fill;
    }
}

TEST(FewThreads, AreEnoughForPictures) {
    // one instead of three threads that compress
    const auto folder = fresh_folder();
    const Words line =
        "render butterfly --size 128x72 --set scene.duration_s=0.2 --frames 0:20 --jobs 3 --format png --progress none";
    int needed = 1;
    while (needed < 8 && code_with_threads(needed, line) != 0) ++needed;
    EXPECT_LT(needed, 8);  // measured 3: two are OpenGL's
    EXPECT_EQ(listing(folder / "out/butterfly/frames").size(), 20u);
}

}  // namespace doppel::few_threads_test

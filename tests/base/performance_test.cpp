#include "bench/kept/performance.hpp"

#include "errors.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <tuple>

// The stored results of the benchmarks, and the tables made from them.

namespace doppel::performance_test {

const std::filesystem::path docs = DOPPEL_SOURCE_DIR "/docs";

TEST(Performance, TablesAreThoseOfTheKeptFile) {
    const auto page = read_page(docs / "performance.md");
    EXPECT_EQ(with_tables(page, read_performance(docs / "performance.json")), page)
        << "run tests/update-performance --tables";
}

TEST(Performance, TablesFollowTheNumbersAndNothingElseChanges) {
    const auto page = read_page(docs / "performance.md");
    auto all = read_performance(docs / "performance.json");
    all.benchmarks.at("P1_90_90_10s/1e-03").ns = 12'345'000;
    all.machine = "an abacus";
    const auto made = with_tables(page, all);
    EXPECT_NE(made.find("| P1: 90°/90°, 10 s | 12345 |"), std::string::npos);
    EXPECT_NE(made.find("an abacus; "), std::string::npos);
    EXPECT_EQ(with_tables(made, read_performance(docs / "performance.json")), page);
}

TEST(Performance, OfRoundsIsTheMedianAndTheirMiddleHalf) {
    const auto made = summary({{30, 3}, {10, 1}, {20, 9}, {100, 2}, {40, 2.5}});
    EXPECT_EQ(made.ns, 30);
    EXPECT_EQ(made.ratio, 2.5);
    EXPECT_NEAR(made.spread, (40.0 - 20) / 2 / 30, 1e-15);
    EXPECT_EQ(made.rounds, 5);
    EXPECT_EQ(summary({{10, 1}, {20, 2}}).ns, 15);
}

TEST(Performance, ReportsLossesAboveALimit) {
    Performance kept, now;
    for (const auto& [name, before, after] :
         {std::tuple("same", 2.0, 2.0), {"quicker", 2.0, 1.0}, {"nearly", 0.85, 0.999}, {"slower", 0.85, 1.001}})
        kept.benchmarks[name].ratio = before, now.benchmarks[name].ratio = after;
    kept.benchmarks["gone"].ratio = 1;
    now.benchmarks["new"].ratio = 1;
    const auto fell = falls(kept, now, 0.15);
    ASSERT_EQ(fell.size(), 1u);
    EXPECT_EQ(fell[0].name, "slower");
    EXPECT_EQ(fell[0].before, 0.85);
    EXPECT_EQ(fell[0].now, 1.001);
}

TEST(Performance, IsKeptAsItIs) {
    auto all = read_performance(docs / "performance.json");
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / "performance.json";
    std::filesystem::create_directories(path.parent_path());
    write_performance(path, all);
    EXPECT_EQ(read_page(path), read_page(docs / "performance.json"));
    write_page(path, "{\"machine\": 3}");
    EXPECT_THROW(read_performance(path), Error);
    EXPECT_THROW(read_performance(path.parent_path() / "none.json"), Error);
}

}  // namespace doppel::performance_test

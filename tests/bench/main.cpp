#include "base/error.hpp"
#include "bench/kept/performance.hpp"
#include "bench/measure.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <vector>

// Google Benchmark's program, and four commands for its stored results:
//     bench --keep FILE [PART]    measures all benchmarks, or those with PART in their name, and stores the results
//     bench --compare FILE        measures benchmarks below two seconds; exit code 1 if one is 15 % slower
//     bench --tables FILE PAGE    rewrites the tables of a page
//     bench --add FILE NAME CPU_S WALL_S UNITS    stores a measurement made elsewhere

namespace doppel {
namespace {

constexpr double most_fall = 0.15;

/// Measures the benchmarks with `part` in their names; the results of the others remain.
void keep(const std::string& path, const std::string& part) {
    const auto names = benchmark_names();
    std::vector<std::string> requested;
    std::copy_if(names.begin(), names.end(), std::back_inserter(requested),
                 [&](const std::string& name) { return name.find(part) != std::string::npos; });
    auto all = measure(requested, 5);
    if (std::filesystem::exists(path))
        for (const auto& [name, one] : read_performance(path).benchmarks)
            if (!part.empty() || name.starts_with("building/")) all.benchmarks.try_emplace(name, one);
    write_performance(path, all);
}

int compare(const std::string& path) {
    const auto kept = read_performance(path);
    std::vector<std::string> names;
    for (const auto& name : benchmark_names()) {
        const auto before = kept.benchmarks.find(key_of(name));
        if (before != kept.benchmarks.end() && before->second.rounds > 1) names.push_back(name);
    }
    const auto seen = falls(kept, measure(names, 3), most_fall);
    // apparent losses are measured again, longer: only those found twice are reported
    std::vector<std::string> again;
    for (const auto& name : names)
        for (const auto& fall : seen)
            if (fall.name == key_of(name)) again.push_back(name);
    const auto fell = again.empty() ? seen : falls(kept, measure(again, 9), most_fall);
    fmt::print(
        "{} of {} benchmarks have less than {:.0f} % of the speed kept in {}, by their ratio to the reference loop.\n",
        fell.size(), names.size(), 100 * (1 - most_fall), path);
    for (const auto& [name, before, now] : fell)
        fmt::print("{:<45} {:>10.4g} → {:<10.4g} {:.0f} % of the speed\n", name, before, now, 100 * before / now);
    return fell.empty() ? 0 : 1;
}

int run(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    const std::string command = words.empty() ? "" : words[0];
    if (command == "--keep" && (words.size() == 2 || words.size() == 3))
        return keep(words[1], words.size() == 3 ? words[2] : ""), 0;
    if (command == "--compare" && words.size() == 2) return compare(words[1]);
    if (command == "--tables" && words.size() == 3)
        return write_page(words[2], with_tables(read_page(words[2]), read_performance(words[1]))), 0;
    if (command == "--add" && words.size() == 6) {
        auto all = read_performance(words[1]);
        all.benchmarks[words[2]] = {.ns = 1e9 * std::stod(words[3]),
                                    .spread = 0,
                                    .ratio = 0,
                                    .rounds = 1,
                                    .counters = {{"wall s", std::stod(words[4])}, {"units", std::stod(words[5])}}};
        return write_performance(words[1], all), 0;
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

}  // namespace
}  // namespace doppel

int main(int argc, char** argv) {
    try {
        return doppel::run(argc, argv);
    } catch (const doppel::Error& error) {
        std::fprintf(stderr, "bench: %s\n", error.what());
        return static_cast<int>(error.code());
    }
}

#include "bench/measure.hpp"

#include "base/error.hpp"

#include <benchmark/benchmark.h>
#include <fmt/chrono.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

namespace doppel {
namespace {

/// The value in a line `name : value` or `NAME="value"` of a file.
std::string said_in(const char* path, const std::string& name) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(name)) continue;
        const auto from = line.find_first_not_of("\t :=\"", name.size());
        return from == std::string::npos ? "" : line.substr(from, line.find_last_not_of('"') + 1 - from);
    }
    return "an unknown one";
}

/// The one result of a benchmark.
class Result final : public benchmark::BenchmarkReporter {
public:
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const auto& run : runs) {
            if (run.run_type != Run::RT_Iteration || run.iterations == 0) continue;
            const auto name = run.benchmark_name();
            const bool by_clock =
                name.find("/real_time") != std::string::npos || name.find("/manual_time") != std::string::npos;
            ns = 1e9 * (by_clock ? run.real_accumulated_time : run.cpu_accumulated_time) /
                 static_cast<double>(run.iterations);
            for (const auto& [counter, value] : run.counters) counters[counter] = value.value;
        }
    }

    double ns = 0;
    std::map<std::string, double> counters;
};

void set_flag(std::string flag) {
    std::string program = "bench";
    char* words[] = {program.data(), flag.data(), nullptr};
    int count = 2;
    benchmark::Initialize(&count, words);
}

Result result_of(const std::string& name) {
    std::string exactly = "^";
    for (const char c : name) {
        if (std::string("+.()[]{}*?|\\^$").find(c) != std::string::npos) exactly += '\\';
        exactly += c;
    }
    Result result;
    benchmark::RunSpecifiedBenchmarks(&result, nullptr, exactly + "$");
    if (!(result.ns > 0)) throw method_failed("{} gives no result", name);
    return result;
}

}  // namespace

std::vector<std::string> benchmark_names() {
    // Google Benchmark lists the names where its reporter prints
    std::ostringstream list;
    Result reporter;
    reporter.SetOutputStream(&list);
    set_flag("--benchmark_list_tests=true");
    benchmark::RunSpecifiedBenchmarks(&reporter, nullptr, ".");
    set_flag("--benchmark_list_tests=false");
    std::vector<std::string> names;
    std::istringstream lines(list.str());
    for (std::string line; std::getline(lines, line);)
        if (line != "reference") names.push_back(line);
    return names;
}

std::string key_of(const std::string& name) {
    std::string key = name;
    for (const char* how : {"/iterations:", "/real_time", "/manual_time", "/process_time"})
        key = key.substr(0, key.find(how));
    return key;
}

Performance measure(const std::vector<std::string>& names, int rounds) {
    constexpr double long_s = 2;
    set_flag("--benchmark_min_time=0.05");

    std::map<std::string, std::vector<Round>> all;
    std::map<std::string, std::map<std::string, double>> counters;
    std::vector<Round> references;
    double before = result_of("reference").ns;
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < names.size(); ++i) {
            auto& taken = all[key_of(names[i])];
            if (round > 0 && taken[0].ns > 1e9 * long_s) continue;
            std::fprintf(stderr, "\rround %d of %d: %zu of %zu  ", round + 1, rounds, i + 1, names.size());
            const auto result = result_of(names[i]);
            const double after = result_of("reference").ns, reference = (before + after) / 2;
            taken.push_back({result.ns, result.ns / reference});
            references.push_back({after, 1});
            before = after;
            // counters of the fastest round
            auto& kept = counters[key_of(names[i])];
            if (kept.empty() || result.ns <= std::min_element(taken.begin(), taken.end(), [](auto& one, auto& other) {
                                                 return one.ns < other.ns;
                                             })->ns)
                kept = result.counters;
        }
    std::fprintf(stderr, "\n");

    Performance made{.machine = fmt::format("{} cores of {}", std::thread::hardware_concurrency(),
                                            said_in("/proc/cpuinfo", "model name")),
                     .system = said_in("/etc/os-release", "PRETTY_NAME="),
                     .compiler = fmt::format("GCC {}", __VERSION__),
                     .date = fmt::format("{:%B %Y}", fmt::gmtime(std::time(nullptr))),
                     .reference_ns = 0,
                     .reference_spread = 0,
                     .benchmarks = {}};
    if (!references.empty()) {
        const auto reference = summary(references);
        made.reference_ns = reference.ns;
        made.reference_spread = reference.spread;
    }
    for (const auto& [name, taken] : all) {
        made.benchmarks[name] = summary(taken);
        made.benchmarks[name].counters = counters[name];
    }
    return made;
}

}  // namespace doppel

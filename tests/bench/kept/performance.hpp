#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace doppel {

/// The result of one benchmark: the median of its rounds.
struct Measured {
    double ns = 0;      // per iteration; CPU time, or elapsed time if the benchmark requests it
    double spread = 0;  // relative deviation that half of the rounds do not exceed
    double ratio = 0;   // to the reference loop just before and after: makes machines comparable
    int rounds = 0;
    std::map<std::string, double> counters;
};

/// The contents of docs/performance.json.
struct Performance {
    std::string machine, system, compiler, date;
    double reference_ns = 0, reference_spread = 0;  // of the reference loop, over all rounds
    std::map<std::string, Measured> benchmarks;
};

/// The time and ratio of one round; summary() returns medians and spread of at least one round.
struct Round {
    double ns, ratio;
};
Measured summary(const std::vector<Round>& rounds);

/// Throw Error: exit 4 if the file cannot be read or written, exit 2 if its content is invalid.
Performance read_performance(const std::filesystem::path& path);
void write_performance(const std::filesystem::path& path, const Performance& all);
std::string read_page(const std::filesystem::path& path);
void write_page(const std::filesystem::path& path, const std::string& text);

/// The page with new text between the lines `<!-- measured: NAME -->` and `<!-- end of NAME -->` of each
/// table. Throws Error (exit 2) for a table without these lines, or if one of its benchmarks is missing.
std::string with_tables(const std::string& page, const Performance& all);

/// A benchmark that is slower than before, by its ratio to the reference loop.
struct Fall {
    std::string name;
    double before, now;
};
/// Benchmarks that lost more than `maximum` of their speed: 0.15 means less than 0.85 of the stored speed. Benchmarks
/// that only one of the two has are ignored.
std::vector<Fall> falls(const Performance& kept, const Performance& now, double maximum);

}  // namespace doppel

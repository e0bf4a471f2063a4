#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace doppel {

/// What one benchmark took, in the middle (median) of its rounds.
struct Measured {
    double ns = 0;      // an iteration; of a benchmark that says so the wall's time, else CPU time
    double spread = 0;  // half of the rounds are within so much of it, relative
    double ratio = 0;   // to the reference loop just before and after, which makes machines comparable
    int rounds = 0;
    std::map<std::string, double> counters;
};

/// What docs/performance.json keeps.
struct Performance {
    std::string machine, system, compiler, date;
    double reference_ns = 0, reference_spread = 0;  // of the reference loop, over all rounds
    std::map<std::string, Measured> benchmarks;
};

/// Of rounds that each took `ns` and `ratio`: the medians and the spread. At least one.
struct Round {
    double ns, ratio;
};
Measured summary(const std::vector<Round>& rounds);

/// Throw Error: exit 4 where the file cannot be read or written, exit 2 where it is none of these.
Performance read_performance(const std::filesystem::path& path);
void write_performance(const std::filesystem::path& path, const Performance& all);
std::string read_page(const std::filesystem::path& path);
void write_page(const std::filesystem::path& path, const std::string& text);

/// The page with what stands between the lines `<!-- measured: NAME -->` and `<!-- end of NAME -->` made anew, for each
/// table. Throws Error (exit 2) for a table without its marks, or of which a benchmark is missing.
std::string with_tables(const std::string& page, const Performance& all);

/// A benchmark that takes longer than it did, by its ratio to the reference loop.
struct Fall {
    std::string name;
    double before, now;
};
/// Those by more than `most` of the speed: 0.15 where a benchmark has less than 0.85 of the kept one's. What only one
/// of both has is left out.
std::vector<Fall> falls(const Performance& kept, const Performance& now, double maximum);

}  // namespace doppel

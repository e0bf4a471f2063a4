#pragma once

#include "bench/kept/performance.hpp"

#include <string>
#include <vector>

namespace doppel {

/// Of all benchmarks but the reference loop, as Google Benchmark names them.
std::vector<std::string> benchmark_names();

/// What a benchmark is kept as: its name without how it is timed.
std::string key_of(const std::string& name);

/// Runs each benchmark once a round, the reference loop before and after; what takes more than two seconds in the first
/// round only. Says on standard error how far it is.
/// Throws Error: exit 3 where a benchmark gives no result.
Performance measure(const std::vector<std::string>& names, int rounds);

}  // namespace doppel

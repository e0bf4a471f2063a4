#pragma once

#include "bench/kept/performance.hpp"

#include <string>
#include <vector>

namespace doppel {

/// The names of all benchmarks except the reference loop, in Google Benchmark's form.
std::vector<std::string> benchmark_names();

/// The key of a stored benchmark: its name without the way of timing.
std::string key_of(const std::string& name);

/// Runs each benchmark once per round, the reference loop before and after. Benchmarks above two seconds run in the
/// first round only. Prints its progress to standard error.
/// Throws Error: exit 3 if a benchmark has no result.
Performance measure(const std::vector<std::string>& names, int rounds);

}  // namespace doppel

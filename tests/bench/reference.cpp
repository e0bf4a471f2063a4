#include <benchmark/benchmark.h>

// The reference loop, which makes the times of different machines comparable: never change it.

namespace doppel {
namespace {

/// Four logistic maps in parallel, a million steps: additions and multiplications of doubles, each dependent on the one
/// before, without memory access.
void reference(benchmark::State& state) {
    double x[] = {0.1, 0.2, 0.3, 0.4};
    for (auto _ : state) {
        for (int i = 0; i < 1'000'000; ++i)
            for (double& each : x) each = 3.9 * each * (1 - each);
        benchmark::DoNotOptimize(x);
    }
}
BENCHMARK(reference)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace doppel

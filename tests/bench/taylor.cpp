#include "integrate/taylor.hpp"

#include "integrate/flow.hpp"
#include "physics/pendulums.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

// The Taylor method: the time for an angle error at the end within the target, for four double
// and triple pendulums; and the cost of a step of a long chain.

namespace doppel {
namespace {

/// The loosest tolerance, of eight per decade, whose error is within the target, as are those of the next two: a single
/// one could be luck.
template <int N>
double tolerance_for(const Pendulum<double>& p, double seconds, double target) {
    const auto exact = end_of<Taylor, AngleChain<Quad, N>>(p.cast<Quad>(), seconds, 1e-26);
    int good = 0;
    for (int eighth = -16; eighth >= -120; --eighth) {
        const auto end = end_of<Taylor, AngleChain<double, N>>(p, seconds, std::pow(10, eighth / 8.0));
        double error = 0;
        for (int i = 0; i < N; ++i)
            error = greater(error, std::abs(static_cast<double>(Quad(Quad(end[i]) - exact[i]))));
        good = error <= target ? good + 1 : 0;
        if (good == 3) return std::pow(10, (eighth + 2) / 8.0);
    }
    return 1e-15;
}

template <int N>
void reach(benchmark::State& state, const std::vector<double>& degrees, double seconds, double target) {
    const auto p = from_rest(degrees);
    const double tolerance = tolerance_for<N>(p, seconds, target);
    for (auto _ : state) benchmark::DoNotOptimize(end_of<Taylor, AngleChain<double, N>>(p, seconds, tolerance));
    state.counters["tolerance"] = tolerance;
}

void step_of_chain(benchmark::State& state) {
    const auto links = static_cast<std::size_t>(state.range(0));
    auto p = from_rest(std::vector<double>(links, 80.0));
    for (auto& length : p.length) length = 1 / static_cast<double>(links);
    using Model = AngleChain<double, Eigen::Dynamic>;
    Model model(p);
    TaylorStepper<Model> stepper(model, Model::start(p), 1e-12);
    stepper.advance(1e-9);
    const double interval = static_cast<double>(stepper.smallest_step());
    const long before = stepper.steps();
    for (auto _ : state) stepper.advance(interval);
    using Counter = benchmark::Counter;
    const auto steps = static_cast<double>(stepper.steps() - before);
    state.counters["s/step"] = Counter(steps, Counter::kIsRate | Counter::kInvert);
    state.counters["s/step/link"] = Counter(steps * static_cast<double>(links), Counter::kIsRate | Counter::kInvert);
    state.SetComplexityN(state.range(0));
}
BENCHMARK(step_of_chain)->RangeMultiplier(2)->Range(8, 1024)->Complexity()->Unit(benchmark::kMicrosecond);

const bool registered = [] {
    for (double target : {1e-3, 1e-6, 1e-9, 1e-12}) {
        const auto add = [&](const std::string& name, auto run) {
            benchmark::RegisterBenchmark(fmt::format("{}/{:.0e}", name, target).c_str(), run)
                ->Unit(benchmark::kMicrosecond);
        };
        add("P1_90_90_10s", [target](benchmark::State& state) { reach<2>(state, {90, 90}, 10, target); });
        add("P2_30_0_60s", [target](benchmark::State& state) { reach<2>(state, {30, 0}, 60, target); });
        add("P3_150_90_5s", [target](benchmark::State& state) { reach<2>(state, {150, 90}, 5, target); });
        add("P4_120_0_0_5s", [target](benchmark::State& state) { reach<3>(state, {120, 0, 0}, 5, target); });
    }
    return true;
}();

}  // namespace
}  // namespace doppel
